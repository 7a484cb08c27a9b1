"""Who drives is where the vehicle is, and so is what it carries; fuel is no place."""

import serendipity
from serendipity.pictures import Scene
from serendipity.pictures.map.places import Whereabouts, find_places

DORA, ROLO = 0, 1


def test_places_are_also_where_only_vehicles_go() -> None:
    places = find_places(serendipity.example("parcels"))
    assert places.names == ("depot", "home", "inn", "lane", "market", "mill")
    assert ("depot", "home") in places.links and ("inn", "market") in places.links


def epoch_of(scene: Scene, agent: int, verb: str, detail: str) -> int:
    return next(
        act.epoch for act in scene.acts if (act.agents, act.verb, act.detail) == ((agent,), verb, detail)
    )


def test_a_driver_is_on_the_map_all_the_time(parcels: Scene) -> None:
    assert [frame.at[DORA] for frame in parcels.frames[:6]] == ["home", *["depot"] * 3, "inn", "inn"]
    rolo = [frame.at[ROLO] for frame in parcels.frames]
    for epoch, place in enumerate(rolo[1:], start=1):
        assert place == rolo[epoch - 1] or epoch == epoch_of(parcels, ROLO, "go to", place)
    assert (rolo[0], rolo[-1]) == ("mill", "inn")


def test_what_is_loaded_is_with_the_driver(parcels: Scene) -> None:
    flour = [frame.objects["flour"] for frame in parcels.frames]
    loaded, delivered = (epoch_of(parcels, ROLO, verb, "flour") for verb in ("load", "deliver"))
    taken = epoch_of(parcels, DORA, "load", "flour")
    assert flour[:taken] == [
        *[Whereabouts("mill")] * loaded,
        *[Whereabouts(holder=ROLO, carrier="cart")] * (delivered - loaded),
        *[Whereabouts("inn")] * (taken - delivered),
    ]
    assert flour[taken] == Whereabouts(holder=DORA, carrier="van")
    assert flour[-1] == Whereabouts("market")


def test_a_vehicle_is_drawn_with_and_without_a_driver(parcels: Scene) -> None:
    van = [frame.objects["van"] for frame in parcels.frames]
    assert van[:3] == [Whereabouts("depot"), Whereabouts("depot"), Whereabouts("depot", riders=(DORA,))]


def test_driving_is_going_somewhere_and_loading_names_the_load(parcels: Scene) -> None:
    dora = {act.epoch: (act.verb, act.detail) for act in parcels.acts if act.agents == (DORA,)}
    assert dora[2] == ("enter", "van")
    assert dora[3] == ("load", "box")
    assert dora[4] == ("go to", "inn")
    assert dora[5] == ("deliver", "box")


def test_what_one_vehicle_brings_and_another_takes_changes_hands(parcels: Scene) -> None:
    (meeting,) = parcels.meetings
    assert meeting.epoch == epoch_of(parcels, DORA, "load", "flour")
    assert (meeting.place, meeting.objects) == ("inn", ("flour",))
    assert meeting.text == "dora takes flour, which rolo left"


def test_levels_of_fuel_are_no_places() -> None:
    places = find_places(serendipity.example("flights"))
    assert places.names == ("capital", "harbour", "island", "ridge")
    assert sorted(places.objects) == ["ann", "bob"]


def test_three_taxis_have_three_positions() -> None:
    places = find_places(serendipity.example("taxis"))
    assert sorted(places.positions) == [0, 1, 2]
    assert sorted(places.objects) == ["ann", "ben"]
