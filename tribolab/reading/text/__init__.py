"""Format of text files, for files of any instrument: encoding, cells, dates, numbers."""
