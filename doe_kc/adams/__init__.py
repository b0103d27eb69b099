"""ADAMS/Car files: subsystems, assemblies and property files to an axle file, and back."""
