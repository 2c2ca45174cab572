"""What leaves the renderer: pictures as bytes, files written whole."""
