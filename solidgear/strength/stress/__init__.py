"""Stress of a shaft: section forces, nominal stress, fillets, and notches rated by DIN 743."""
