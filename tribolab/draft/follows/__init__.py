"""What follows from columns and from what is stated, and all of it understood together."""
