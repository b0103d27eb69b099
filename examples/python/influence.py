"""The parameter-influence matrix as a DataFrame and as a heat map."""

import argparse
from pathlib import Path

import doe_kc as kc

EXAMPLE = Path(__file__).parents[1] / "front_axle"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", nargs="?", default=EXAMPLE, help="study file or folder")
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder of the picture and the table")
    options = parser.parse_args()

    influence = kc.influence(options.study)
    matrix = influence.to_frame()
    print(influence)
    print("strongest on bump steer, percent of the largest:")
    print(matrix["vertical.bump_steer"].sort_values(key=abs, ascending=False).head(8).round(1).to_string())

    options.out.mkdir(parents=True, exist_ok=True)
    matrix.to_csv(options.out / "influence.csv")
    influence.plot().figure.savefig(options.out / "influence.png", dpi=150)
    print(f"wrote {options.out / 'influence.csv'} and {options.out / 'influence.png'}")


if __name__ == "__main__":
    main()
