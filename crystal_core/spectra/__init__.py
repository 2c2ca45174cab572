"""Spectra and colour: wavelengths, the light, the eye, and the way to sRGB.

``observer`` holds the CIE 1931 colour matching functions, ``illuminants`` D65, ``reflectance`` the spectra that stand
for RGB colours of textures, ``colour`` the way from XYZ to the pixels of a file. The tables are small text files beside
them, read at first use.
"""
