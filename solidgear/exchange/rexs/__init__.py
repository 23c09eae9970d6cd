"""Gearboxes in REXS, the exchange format of the gear industry (FVA, versions 1.0 to 2.0).

A file holds components with attributes, relations between components, and load spectra.
:mod:`solidgear.exchange.rexs.document` is the format alone.
"""
