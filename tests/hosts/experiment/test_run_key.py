"""Equal keys for runs with equal FMU, settings, files and program."""

from pathlib import Path

from hosts.experiment.store import run_key


def test_the_key_depends_on_the_fmu_its_files_and_the_settings(tmp_path: Path) -> None:
    fmu, road = tmp_path / "a.fmu", tmp_path / "flat.road"
    fmu.write_bytes(b"first")
    road.write_bytes(b"flat")
    keys = [run_key(fmu, "drop", {"x": 1.0}, files=[road])]
    assert run_key(fmu, "drop", {"x": 1.0}, files=[road, tmp_path / "kerb.road"]) == keys[0]  # one within the FMU
    keys += [run_key(fmu, "drop", {"x": 2.0}, files=[road]), run_key(fmu, "drop", {"x": 1.0})]
    road.write_bytes(b"a hill")
    keys.append(run_key(fmu, "drop", {"x": 1.0}, files=[road]))
    fmu.write_bytes(b"another")
    keys.append(run_key(fmu, "drop", {"x": 1.0}, files=[road]))
    assert len(set(keys)) == len(keys)
