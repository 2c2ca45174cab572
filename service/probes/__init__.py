"""Questions to the optics with an answer at once: JSON in, JSON out, alike at the command line and over HTTP."""
