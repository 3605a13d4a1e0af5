"""Prints the folder below PREFIX, its argument, in which this Python finds modules."""

import sys
import sysconfig

prefix = sys.argv[1]
version = f"python{sys.version_info.major}.{sys.version_info.minor}"
if "deb_system" in sysconfig.get_scheme_names() or "dist-packages" in sysconfig.get_path("purelib"):
    places = {"/usr": "lib/python3/dist-packages", "/usr/local": f"lib/{version}/dist-packages"}
else:
    places = {}
print(f"{prefix}/{places.get(prefix, f'lib/{version}/site-packages')}")
