"""What a run leaves: facts, traces, trends, decisions and notices."""
