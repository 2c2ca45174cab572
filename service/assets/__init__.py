"""Files that callers hand over: pictures to print, meshes of their own."""
