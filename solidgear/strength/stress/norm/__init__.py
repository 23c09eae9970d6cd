"""Formulas of DIN 743:2012 for notches: tested factors, form factors, steels, life."""
