"""3D solids: tetrahedra, hexahedra, parts from files."""
