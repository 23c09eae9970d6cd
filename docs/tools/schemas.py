"""The schema files of the package, from the types that read files.

    python docs/tools/schemas.py

Writes `solidgear/show/schema/*.json`.
"""

from solidgear.show.schema.files import write

if __name__ == "__main__":
    write()
