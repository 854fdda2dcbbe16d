"""How a contact slides: the evidence, the verdict, and its words."""
