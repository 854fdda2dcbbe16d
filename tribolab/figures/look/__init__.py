"""Common style of all figures: sizes, colours, texts, ticks and layout."""
