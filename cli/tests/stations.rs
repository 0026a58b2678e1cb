//! Records of stations: horizontal and vertical components of one record by its name, in scenes and as an axis of sweeps.

mod common;

use common::{rocking, root, succeeds};
use rocking::{Motion, Scene, Sweep};
use std::path::Path;

const COLUMN: &str = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 1.0\n";

/// A folder with two records of three components, and files that are none of theirs.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let records = folder.path().join("records");
    std::fs::create_dir(&records).expect("made");
    let peer = root().join("ground/tests/records/peer");
    for ending in ["000", "090", "-UP"] {
        for number in [9001, 9002] {
            let from = peer.join(format!("RSN9001_HOLLOW_MIL{ending}.AT2"));
            std::fs::copy(from, records.join(format!("RSN{number}_HOLLOW_MIL{ending}.AT2"))).expect("copied");
        }
    }
    // PEER gives velocities beside accelerations.
    std::fs::copy(peer.join("velocity.VT2"), records.join("RSN9001_HOLLOW_MIL000.VT2")).expect("copied");
    folder
}

fn scene(folder: &Path, excitation: &str) -> Result<Scene, String> {
    let file = folder.join("s.toml");
    Scene::from_toml(&format!("{COLUMN}{excitation}"), &file).map_err(|error| error.to_string())
}

#[test]
fn a_station_is_its_components_scaled_by_one_factor() {
    let folder = folder();
    let path = folder.path();
    let record = |key: &str, file: &str, size: &str| {
        format!("[excitation.{key}]\nkind = \"record\"\nfile = \"records/RSN9001_HOLLOW_MIL{file}.AT2\"\n{size}\n")
    };
    for (component, file) in
        [("", "000"), ("component = \"H1\"", "000"), ("component = \"h2\"", "090"), ("component = \"090\"", "090")]
    {
        let own =
            scene(path, &format!("[excitation.station]\nrecord = \"records/RSN9001\"\n{component}\n")).expect("valid");
        assert_eq!(own, scene(path, &record("horizontal", file, "")).expect("valid"), "{component}");
        let sized = format!(
            "[excitation.station]\nrecord = \"records/RSN9001\"\n{component}\nvertical = true\npgv = 0.3\nstart = 1\n"
        );
        let sized = scene(path, &sized).expect("valid");
        let alone = scene(path, &record("horizontal", file, "pgv = 0.3\nstart = 1")).expect("valid");
        assert_eq!(sized.excitation.horizontal, alone.excitation.horizontal);
        // The vertical component has the factor of the horizontal one.
        let factor = |motion: &Option<Motion>| match motion {
            Some(Motion::Record(record)) => record.scale(),
            other => panic!("{other:?}"),
        };
        let common = factor(&sized.excitation.horizontal);
        let vertical =
            scene(path, &record("vertical", "-UP", &format!("scale = {common:?}\nstart = 1"))).expect("valid");
        assert_eq!(sized.excitation.vertical, vertical.excitation.vertical, "{component}");
    }
}

#[test]
fn an_axis_takes_the_records_of_a_folder_with_their_components() {
    let folder = folder();
    let path = folder.path();
    let write = |name: &str, text: &str| std::fs::write(path.join(name), text).expect("written");
    write(
        "base.toml",
        &format!(
            "{COLUMN}[excitation.station]\nrecord = \"records/RSN9001\"\nvertical = true\npga_g = 0.4\n[solver]\nt_end = 4.0\n"
        ),
    );
    write(
        "sweep.toml",
        "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nrecord = { folder = \"records\" }\ncomponent = [\"H1\", \"H2\"]\npga_g = [0.3, 0.5]\n",
    );
    let told = succeeds(path, &["check", "sweep.toml"]);
    assert!(told.contains("excitation.station.record: 2 value(s), from records/RSN9001 to records/RSN9002"), "{told}");
    let told = succeeds(path, &["sweep", "sweep.toml", "--plot", "f.svg"]);
    assert!(told.contains("errors 0") && told.contains("4 records with their"), "{told}");
    let sweep = Sweep::from_file(&path.join("sweep.toml")).expect("valid");
    assert_eq!(sweep.len(), 8);
    for row in sweep.rows(0..8) {
        let (component, size) = (["000", "090"][row.index / 2 % 2], [0.3, 0.5][row.index % 2]);
        let number = 9001 + row.index / 4;
        let own = sweep.scene(row.index).expect("valid");
        let file = format!("records/RSN{number}_HOLLOW_MIL{component}.AT2");
        let alone = format!(
            "[excitation.horizontal]\nkind = \"record\"\nfile = \"{file}\"\npga_g = {size}\n[solver]\nt_end = 4.0\n"
        );
        let alone = scene(path, &alone).expect("valid");
        assert_eq!(own.excitation.horizontal, alone.excitation.horizontal, "{}", row.index);
        assert!(matches!(own.excitation.vertical, Some(Motion::Record(_))));
        // The run of the row is that of its scene alone.
        let mut single = own.clone();
        single.output_dt = None;
        let response = rocking::simulate(&single).expect("runs");
        assert_eq!(row.result.expect("runs").peaks, response.peaks(&single.column));
    }
    // A component is part of the sweep: no output replaces it, and the digest is another one with another vertical component.
    let up = "records/RSN9002_HOLLOW_MIL-UP.AT2";
    let output = rocking(path, &["sweep", "sweep.toml", "--out", up]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let digest = || {
        succeeds(path, &["sweep", "sweep.toml", "--shard", "1/1", "--out", "d.csv"]);
        std::fs::read_to_string(path.join("d.csv.digest")).expect("written")
    };
    let before = digest();
    let text = std::fs::read_to_string(path.join(up)).expect("there");
    write(up, &format!("{text}\n"));
    let changed = digest();
    write(up, &text);
    assert!(before != changed && before == digest());

    // A record without the component is a row with its error, and all others have results.
    std::fs::remove_file(path.join("records/RSN9002_HOLLOW_MIL090.AT2")).expect("there");
    let told = succeeds(path, &["sweep", "sweep.toml"]);
    assert!(told.contains("errors 2"), "{told}");
    let table = std::fs::read_to_string(path.join("sweep.csv")).expect("written");
    let said = "RSN9002: it has no horizontal component `H2`, only records/RSN9002_HOLLOW_MIL-UP.AT2, records/RSN9002_HOLLOW_MIL000.AT2; choose H1, H2 or the end of a file's name, or leave the record out";
    assert_eq!(table.matches(said).count(), 2, "{table}");
}

#[test]
fn a_record_without_what_is_asked_for_is_refused_with_file_and_remedy() {
    let folder = folder();
    let path = folder.path();
    std::fs::remove_file(path.join("records/RSN9002_HOLLOW_MIL-UP.AT2")).expect("there");
    let station = |keys: &str| format!("[excitation.station]\n{keys}\n");
    for (excitation, said) in [
        (
            station("record = \"records/RSN9001\"\ncomponent = \"H3\""),
            ["RSN9001: it has no horizontal component `H3`, only", "leave the record out"],
        ),
        (
            station("record = \"records/RSN9001\"\ncomponent = \"UP\""),
            ["no horizontal component `UP`", "choose H1, H2"],
        ),
        (
            station("record = \"records/RSN9002\"\nvertical = true"),
            ["RSN9002: it has no vertical component, only", "leave `vertical` out"],
        ),
        (station("record = \"records/RSN9\""), ["RSN9: no file of", "name one of RSN9001, RSN9002"]),
        (station("record = \"nowhere/RSN9\""), ["nowhere", "relative to the file that names it"]),
        (station("component = \"H1\""), ["station.record", "without its component"]),
        (station("record = \"records/RSN9001\"\nscale = 2\npga_g = 0.3"), ["pga_g", "`scale` is given as well"]),
        (station("record = \"records/RSN9001\"\nkind = \"record\""), ["kind", "station"]),
        (
            station(
                "record = \"records/RSN9001\"\n[excitation.vertical]\nkind = \"harmonic\"\namplitude = 1\nomega = 3",
            ),
            ["vertical", "`station` is given as well"],
        ),
    ] {
        let message = scene(path, &excitation).expect_err(&excitation);
        assert!(said.iter().all(|part| message.contains(part)), "{excitation}\n{message}");
    }
}
