"""Strongest links and groups of characteristics."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.parameter_influence.relations import Together, column_correlation, relations
from tests.parameter_influence.studies import real_study, study


def test_links_are_sorted_signed_and_cut_at_the_threshold() -> None:
    found = relations(study([[10.0], [-5.0], [1.9], [-2.0]]))
    links = found.by_characteristic[0].links
    assert [(link.parameter, link.percent) for link in links] == [
        ("P0.x", 100.0),
        ("P1.x", -50.0),
        ("P3.x", -20.0),
    ]


def test_at_most_so_many_links() -> None:
    found = relations(study([[float(k)] for k in range(20, 40)]), at_most=8)
    assert [link.parameter for link in found.by_characteristic[0].links] == [
        f"P{k}.x" for k in range(19, 11, -1)
    ]
    assert found.longest == 8


def test_parameter_lists_what_it_moves_most() -> None:
    found = relations(study([[10.0, -1.0, 0.1], [1.0, 2.0, 1.0]]))
    assert [(link.characteristic, link.percent) for link in found.by_parameter[0].links] == [
        ("vertical.bump_steer", 100.0),
        ("roll.roll_steer", -50.0),
    ]


def test_proportional_columns_move_together_with_their_sign() -> None:
    found = relations(study([[1.0, -2.0, 1.0], [2.0, -4.0, -1.0], [4.0, -8.0, 0.0]]))
    assert found.together == (Together(("vertical.bump_steer", "roll.roll_steer"), (1, -1), 1.0),)


def test_every_pair_of_a_group_is_above_the_limit() -> None:
    """a ~ b and b ~ c, yet a and c are not: no chain may join the three."""
    angle = np.radians([0.0, 20.0, 40.0])
    x, y = np.array([1.0, -1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, -1.0])
    columns = np.outer(x, np.cos(angle)) + np.outer(y, np.sin(angle))
    found = relations(study(columns.tolist()), together=0.9)
    assert [len(g.characteristics) for g in found.together] == [2]
    assert found.together[0].weakest == pytest.approx(np.cos(np.radians(20.0)))


def test_constant_column_is_correlated_with_none() -> None:
    r = column_correlation(np.array([[1.0, 3.0], [2.0, 3.0]]))
    np.testing.assert_array_equal(r, np.eye(2))


def test_failed_row_and_column_without_entry_are_left_out() -> None:
    found = relations(study([[np.nan, 0.0], [2.0, 0.0]]))
    assert [link.parameter for link in found.by_characteristic[0].links] == ["P1.x"]
    assert found.by_characteristic[1].links == ()
    assert found.together == ()


def test_frame_has_a_row_per_link() -> None:
    frame = relations(study([[10.0], [-5.0]])).to_frame()
    assert frame.to_dict("records")[1] == {
        "characteristic": "vertical.bump_steer",
        "unit": "deg/m",
        "rank": 2,
        "parameter": "P1.x",
        "percent": -50.0,
    }


def test_real_axle_repeats_the_thesis() -> None:
    """Wind-up and longitudinal compliance move together; the rear arm bush leads both (section 5.2.1)."""
    found = relations(real_study())
    group = next(g for g in found.together if "brake.wind_up" in g.characteristics)
    assert "brake.wc_longitudinal_disp" in group.characteristics
    leaders = {e.characteristic.id: e.links[0].parameter for e in found.by_characteristic if e.links}
    assert leaders["brake.wind_up"] == leaders["brake.wc_longitudinal_disp"] == "llr.Fx"
    assert leaders["vertical.bump_steer"] == "RIB.z"
    assert leaders["vertical.ride_rate"] == "spring.rate"
