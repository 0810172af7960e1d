"""How well the parts do on labelled meshes; the verbs of ``shapewright evaluate`` print what is measured here."""
