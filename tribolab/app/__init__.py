"""What each command of the terminal does: questions to the user, tables and messages."""
