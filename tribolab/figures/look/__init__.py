"""The look of all figures: sizes, colours, words, ticks, and the axes that they share."""
