"""An instrument described as data: what its files look like and what their columns hold."""
