"""What the axle lacks against a measured car, and the axle that was extended and correlated."""

import argparse
from pathlib import Path

import doe_kc as kc

EXAMPLE = Path(__file__).parents[1] / "front_axle"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", nargs="?", default=EXAMPLE, help="study file or folder, with a measurement")
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder of the pictures")
    options = parser.parse_args()

    study = kc.read_study(options.study, pictures="none")
    before = kc.compare(study)
    print(before)

    alone = kc.correlate(study)  # the axle as it is, for comparison
    print(alone)

    answer = kc.run(study)  # discovers what it lacks, adds it, correlates
    print(answer)
    if answer.discovery is not None:
        print(answer.discovery.effects[["effect", "size", "value", "sd", "unit"]].to_string(index=False))
    print(answer.characteristics[["target", "baseline", "final", "unit", "inside"]].to_string())

    options.out.mkdir(parents=True, exist_ok=True)
    answer.plot().figure.savefig(options.out / "characteristics.png", dpi=150)
    if answer.discovery is not None:
        answer.discovery.plot().figure.savefig(options.out / "gap.png", dpi=150)
    print(f"wrote pictures to {options.out}; kc.run(study, out=...) writes everything")


if __name__ == "__main__":
    main()
