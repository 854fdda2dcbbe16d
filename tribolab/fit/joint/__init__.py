"""All loads of a surface in one fit: what friction tells of shear stress and liquid together."""
