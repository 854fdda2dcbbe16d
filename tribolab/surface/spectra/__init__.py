"""Power spectra of profiles and maps, their reliable range and their error."""
