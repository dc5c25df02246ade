"""What is drawn and written from a results folder: results and data read it, folder draws all, one module for each kind of plot."""
