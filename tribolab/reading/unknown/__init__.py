"""Files that no dialect describes: layout, columns, header, and the proposed dialect."""
