"""Power spectra of profiles and maps, with their reliable range and error."""
