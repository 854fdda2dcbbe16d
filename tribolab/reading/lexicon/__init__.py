"""What files call things, as data in TOML files, and how it is looked up."""
