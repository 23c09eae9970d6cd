"""Stress of a shaft: section forces, nominal stress, fillets, and the rating of DIN 743."""
