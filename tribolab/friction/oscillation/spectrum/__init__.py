"""The spectrum of a record: lines, mains hum, and what stands out of the noise."""
