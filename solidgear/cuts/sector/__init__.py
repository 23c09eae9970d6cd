"""Parts of equal sectors by cyclic symmetry."""
