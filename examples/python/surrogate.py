"""From a Latin hypercube of designs to a surrogate of every characteristic, and how good it is."""

import argparse
import os
from pathlib import Path

import doe_kc as kc

EXAMPLE = Path(__file__).parents[1] / "front_axle"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", nargs="?", default=EXAMPLE, help="study file or folder")
    parser.add_argument("--designs", type=int, default=int(os.environ.get("DOE_KC_DESIGNS", "200")))
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder of the picture")
    options = parser.parse_args()

    sampling = kc.sample(options.study, options.designs, method="lhs")
    print(sampling)

    last = len(sampling.designs) // 5  # kept aside, to score the surrogate on
    designs, responses = sampling.designs, sampling.responses
    model = kc.Surrogate(space=sampling.space).fit(designs[:-last], responses[:-last])
    print(model.to_frame().to_string(float_format="%.4f"))
    print(f"R² of {last} designs kept aside: {model.score(designs[-last:], responses[-last:]):.4f}")

    options.out.mkdir(parents=True, exist_ok=True)
    model.plot("vertical.bump_steer").figure.savefig(options.out / "surrogate.png", dpi=150)
    print(f"wrote {options.out / 'surrogate.png'}")


if __name__ == "__main__":
    main()
