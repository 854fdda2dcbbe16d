"""Interactive figures of the page (zoom, filters), one module for each subject."""
