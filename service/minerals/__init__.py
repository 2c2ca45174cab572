"""What the command line and the HTTP interface tell of minerals: lists, entries, optics at wavelengths, checks."""
