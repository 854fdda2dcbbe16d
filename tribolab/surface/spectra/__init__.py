"""Power spectra of profiles and maps, with their trusted range and error."""
