"""`python -m doe_kc`."""

from doe_kc.cli import main

if __name__ == "__main__":
    main()
