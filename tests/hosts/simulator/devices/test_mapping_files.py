"""Files of mappings and the names of devices."""

from pathlib import Path

import pytest

from ali3.files import FileError
from hosts.common.errors import HostError
from hosts.simulator.devices.mapping import DeviceMapping, DeviceSettings, InputMapping
from hosts.simulator.devices.mapping_files import MappingFiles
from hosts.simulator.devices.reader import Identities


def test_a_mapping_is_read_as_it_was_written(tmp_path):
    steering = InputMapping("axis 3", inverted=True, low=-0.9, high=1.0 / 3.0, dead_zone=0.1, centre=0.05)
    wheel = DeviceSettings(540.0, 0.1, 7.5, force_inverted=True, smoothing=0.02, damper=0.3, spring=0.7)
    mapping = DeviceMapping({"steering": steering, "selector drive": InputMapping("hat 0 left")}, wheel)
    files = MappingFiles(tmp_path)
    files.write("0300", mapping, 'A "wheel"\n = 1 \\', "A1")
    assert files.read("0300") == mapping
    assert files.serial("0300") == "A1"


def test_without_a_file_there_is_no_mapping(tmp_path):
    files = MappingFiles(tmp_path / "none")
    assert files.read("0300") is None
    assert files.serial("0300") == ""
    files.remove("0300")


GOOD = 'format = "ALi3 device"\nversion = 1\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "it must have format = .* and version = "),
        (GOOD.replace("1", "2"), "it must have format = .* and version = 1"),
        (GOOD + "colour = 1", "'colour' is unknown"),
        (GOOD + "inputs = 3", "inputs = 3 is not a table"),
        (GOOD + "[inputs.brake]\nsource = 'axle'", "'axle' is not a source"),
        (GOOD + "[settings]\nrotation = 'much'", "rotation = 'much'; it must be a number"),
    ],
)
def test_a_damaged_file_is_named_with_its_fault(tmp_path, text, message):
    files = MappingFiles(tmp_path)
    files.path("0300").write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(HostError, match=rf"0300\.toml .*{message}"):
        files.read("0300")


def test_a_file_that_cannot_be_read_or_written_is_named(tmp_path):
    files = MappingFiles(tmp_path)
    files.path("0300").mkdir()
    with pytest.raises(HostError, match=r"0300\.toml is a folder"):
        files.read("0300")
    with pytest.raises(HostError, match=r"0300\.toml cannot be removed"):
        files.remove("0300")
    with pytest.raises(FileError, match=r"0300\.toml is a folder"):
        files.write("0300", DeviceMapping(), "Wheel")


def names(kept: dict[str, str] | None = None) -> Identities:
    return Identities(lambda device: (kept or {}).get(device, ""))


def test_two_of_a_model_come_back_as_they_were_by_place():
    identities = names()
    assert [identities.take("g", "", place) for place in ("usb1", "usb2")] == ["g", "g-2"]
    identities.leave("g")
    identities.leave("g-2")
    assert [identities.take("g", "", place) for place in ("usb2", "usb1")] == ["g-2", "g"]


def test_serial_numbers_tell_them_apart_in_a_later_run():
    kept = {"g": "A", "g-2": "B"}
    identities = names(kept)
    assert [identities.take("g", serial, "") for serial in ("B", "C", "A")] == ["g-2", "g-3", "g"]


def test_without_serial_number_or_place_they_come_in_order():
    identities = names()
    assert [identities.take("g", "", "") for _ in range(3)] == ["g", "g-2", "g-3"]
    identities.leave("g-2")
    assert identities.take("g", "", "") == "g-2"
    assert identities.take("h", "", "") == "h"


def test_the_file_in_the_documents_can_be_read(tmp_path):
    page = (Path(__file__).parents[4] / "docs" / "devices.md").read_text(encoding="utf-8")
    files = MappingFiles(tmp_path)
    files.path("0300").write_text(page.split("```toml\n")[1].split("```")[0], encoding="utf-8")
    mapping = files.read("0300")
    assert mapping is not None
    assert mapping.settings == DeviceSettings(rotation=900.0), "but for the turn of the wheel they are as by default"
    assert set(mapping.inputs) == {"steering", "brake", "selector reverse"}
