"""How text is written, before any dialect: encoding, arrangement, cells, numbers."""
