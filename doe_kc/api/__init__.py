"""What `import doe_kc` offers, one module a result: thin layers over the steps of a study."""
