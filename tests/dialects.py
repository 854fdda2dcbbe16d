"""Dialects of plain tables, as the tests of reading write them."""


def dialect_of(name: str, line: int = 1, more: str = "", **columns: str) -> str:
    """The TOML of a table whose header stands in a line: the names of its columns, by quantity.

    `more` stands before the columns, where the tables of TOML are that hold no list.
    """
    text = f'\nname = "{name}"\ntitle = "{name}"\n[header]\nline = {line}\n{more}'
    for quantity, column in columns.items():
        text += f'[[column]]\nquantity = "{quantity}"\nname = "{column}"\n'
    return text
