"""Recordings in the forms that other programs read: tables, NetCDF, VTK for ParaView, series for OpenFAST."""
