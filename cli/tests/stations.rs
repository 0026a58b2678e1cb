//! Records of stations: horizontal and vertical components of one record by its name, in scenes and as an axis of sweeps.

#[cfg(unix)]
use crate::common::scenes::SCENE;
use crate::common::{Folder, assert_has};
use rocking::{Motion, Scene, Sweep};

const COLUMN: &str = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 1.0\n";

/// A folder with two records of three components, and files that are none of theirs.
fn folder() -> Folder {
    let folder = Folder::new();
    let copy =
        |name: &str, own: &str| folder.copy(&format!("ground/tests/records/peer/{name}"), &format!("records/{own}"));
    for ending in ["000", "090", "-UP"] {
        for number in [9001, 9002] {
            copy(&format!("RSN9001_HOLLOW_MIL{ending}.AT2"), &format!("RSN{number}_HOLLOW_MIL{ending}.AT2"));
        }
    }
    // PEER gives velocities beside accelerations.
    copy("velocity.VT2", "RSN9001_HOLLOW_MIL000.VT2");
    folder
}

fn scene(folder: &Folder, excitation: &str) -> Result<Scene, String> {
    Scene::from_toml(&format!("{COLUMN}{excitation}"), &folder.path("s.toml")).map_err(|error| error.to_string())
}

#[test]
fn a_station_is_its_components_scaled_by_one_factor() {
    let folder = folder();
    let record = |key: &str, file: &str, size: &str| {
        format!("[excitation.{key}]\nkind = \"record\"\nfile = \"records/RSN9001_HOLLOW_MIL{file}.AT2\"\n{size}\n")
    };
    for (component, file) in
        [("", "000"), ("component = \"H1\"", "000"), ("component = \"h2\"", "090"), ("component = \"090\"", "090")]
    {
        let own = scene(&folder, &format!("[excitation.station]\nrecord = \"records/RSN9001\"\n{component}\n"))
            .expect("valid");
        assert_eq!(own, scene(&folder, &record("horizontal", file, "")).expect("valid"), "{component}");
        let sized = format!(
            "[excitation.station]\nrecord = \"records/RSN9001\"\n{component}\nvertical = true\npgv = 0.3\nstart = 1\n"
        );
        let sized = scene(&folder, &sized).expect("valid");
        let alone = scene(&folder, &record("horizontal", file, "pgv = 0.3\nstart = 1")).expect("valid");
        assert_eq!(sized.excitation.horizontal, alone.excitation.horizontal);
        // The vertical component has the factor of the horizontal one.
        let factor = |motion: &Option<Motion>| match motion {
            Some(Motion::Record(record)) => record.scale(),
            other => panic!("{other:?}"),
        };
        let common = factor(&sized.excitation.horizontal);
        let vertical =
            scene(&folder, &record("vertical", "-UP", &format!("scale = {common:?}\nstart = 1"))).expect("valid");
        assert_eq!(sized.excitation.vertical, vertical.excitation.vertical, "{component}");
    }
}

/// Arrays number their stations: the azimuth comes after another number, and the end of a file's name is the azimuth alone.
#[test]
fn azimuths_after_numbers_of_stations_are_ends_of_names() {
    let folder = Folder::new();
    for (own, name) in [("000", "E07140"), ("090", "E07230"), ("-UP", "E07-UP")] {
        let from = format!("ground/tests/records/peer/RSN9001_HOLLOW_MIL{own}.AT2");
        folder.copy(&from, &format!("records/RSN182_IMPVALL.H_H-{name}.AT2"));
    }
    let of = |component: &str| {
        scene(&folder, &format!("[excitation.station]\nrecord = \"records/RSN182\"\ncomponent = \"{component}\"\n"))
    };
    let second = of("H2").expect("valid");
    for name in ["230", "7230", "e07230", "H-E07230"] {
        assert_eq!(of(name).expect("valid"), second, "{name}");
    }
    assert_eq!(of("140").expect("valid"), of("H1").expect("valid"));
    // Both end so, and neither.
    for name in ["0", "50", "UP"] {
        assert_has(&of(name).expect_err("none"), &["no horizontal component", "E07140.AT2", "E07230.AT2"]);
    }
}

/// A converted copy beside a component is that component again: H2 was the copy of H1.
#[test]
fn a_component_in_two_formats_is_refused() {
    let folder = folder();
    let text = folder.read("records/RSN9001_HOLLOW_MIL000.AT2");
    folder.write("records/RSN9001_HOLLOW_MIL000.at2", text);
    let error = scene(&folder, "[excitation.station]\nrecord = \"records/RSN9001\"\ncomponent = \"H2\"\n");
    assert_has(&error.expect_err("two files of one component"), &["MIL000.AT2", "MIL000.at2", "the same component"]);
    folder.write(
        "study.toml",
        "scene = \"column.toml\"\nmeasure = \"pga_g\"\nlevels = [0.1]\n[records]\nfolder = \"records\"\n",
    );
    folder.write("column.toml", COLUMN);
    folder.refused(
        "ida study.toml",
        &["study.toml", "`records.folder`", "the same component", "take one of the two out"],
    );
}

#[test]
fn an_axis_takes_the_records_of_a_folder_with_their_components() {
    let folder = folder();
    folder.write(
        "base.toml",
        format!(
            "{COLUMN}[excitation.station]\nrecord = \"records/RSN9001\"\nvertical = true\npga_g = 0.4\n[solver]\nt_end = 4.0\n"
        ),
    );
    folder.write(
        "sweep.toml",
        "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nrecord = { folder = \"records\" }\ncomponent = [\"H1\", \"H2\"]\npga_g = [0.3, 0.5]\n",
    );
    let told = folder.succeeds("check sweep.toml");
    assert!(told.contains("excitation.station.record: 2 value(s), from records/RSN9001 to records/RSN9002"), "{told}");
    let told = folder.succeeds("sweep sweep.toml --plot f.svg");
    assert_has(&told, &["errors 0", "4 records with their"]);
    let sweep = Sweep::from_file(&folder.path("sweep.toml")).expect("valid");
    assert_eq!(sweep.len(), 8);
    for row in sweep.rows(0..8) {
        let (component, size) = (["000", "090"][row.index / 2 % 2], [0.3, 0.5][row.index % 2]);
        let number = 9001 + row.index / 4;
        let own = sweep.scene(row.index).expect("valid");
        let file = format!("records/RSN{number}_HOLLOW_MIL{component}.AT2");
        let alone = format!(
            "[excitation.horizontal]\nkind = \"record\"\nfile = \"{file}\"\npga_g = {size}\n[solver]\nt_end = 4.0\n"
        );
        let alone = scene(&folder, &alone).expect("valid");
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
    folder.refused(&format!("sweep sweep.toml --out {up}"), &[]);
    let digest = || {
        folder.succeeds("sweep sweep.toml --shard 1/1 --out d.csv");
        folder.read("d.csv.digest")
    };
    let before = digest();
    let text = folder.read(up);
    folder.write(up, format!("{text}\n"));
    let changed = digest();
    folder.write(up, &text);
    assert!(before != changed && before == digest());

    // A record without the component is a row with its error, and all others have results.
    folder.remove("records/RSN9002_HOLLOW_MIL090.AT2");
    let told = folder.succeeds("sweep sweep.toml");
    assert!(told.contains("errors 2"), "{told}");
    let table = folder.read("sweep.csv");
    let said = "RSN9002: it has no horizontal component `H2`, only records/RSN9002_HOLLOW_MIL000.AT2; choose H1, H2 or the end of a file's name, or leave the record out";
    assert_eq!(table.matches(said).count(), 2, "{table}");
}

/// Names that have the same number in them are those of different records.
#[test]
fn records_whose_numbers_are_equal_are_kept_apart() {
    let folder = Folder::new();
    let names = ["GM_1", "GM_01"];
    for (place, name) in names.into_iter().enumerate() {
        folder.write(&format!("r/{name}.csv"), format!("t [s],a [m/s2]\n0,0\n0.1,{}\n0.2,0\n", 1 + place));
        let own =
            scene(&folder, &format!("[excitation.station]\nrecord = \"r/{name}\"\n")).expect("a record of its own");
        let Some(Motion::Record(record)) = own.excitation.horizontal else { panic!("{name}: no record") };
        assert_eq!(record.peak(), 1.0 + place as f64, "{name}");
    }
    folder.write("base.toml", format!("{COLUMN}[excitation.station]\nrecord = \"r/GM_1\"\n"));
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\nrecord = { folder = \"r\" }\n");
    assert_eq!(Sweep::from_file(&folder.path("sweep.toml")).map(|sweep| sweep.len()), Ok(names.len()));
}

#[test]
fn a_record_without_what_is_asked_for_is_refused_with_file_and_remedy() {
    let folder = folder();
    folder.remove("records/RSN9002_HOLLOW_MIL-UP.AT2");
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
        let message = scene(&folder, &excitation).expect_err(&excitation);
        assert!(said.iter().all(|part| message.contains(part)), "{excitation}\n{message}");
    }
}

/// A station's record is found in the scene's own folder as well.
#[test]
fn a_record_beside_the_scene_needs_no_folder() {
    let scene = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.station]\nrecord = \"R1\"\n";
    let folder = Folder::with("scene.toml", scene);
    folder.write("R1_H1.csv", "t (s),a (m/s2)\n0,0\n0.01,1\n0.02,0\n");
    assert!(folder.succeeds("run scene.toml --out out").starts_with("no uplift, stands at rest"));
}

/// A record whose link leads nowhere is missing; without it, another component would stand for the one that was asked for.
#[cfg(unix)]
#[test]
fn links_of_a_folder_that_lead_nowhere_are_refused() {
    let folder = Folder::new();
    let pulse = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude = 4.0\nomega = 10.0\n";
    folder.write("scene.toml", SCENE.replace(pulse, "[excitation.station]\nrecord = \"records/RSN1\"\n"));
    folder.write("records/RSN1_X_090.csv", "t (s),a (m/s2)\n0,0\n0.01,1\n0.02,0\n");
    folder.link("nowhere/RSN1_X_000.csv", "records/RSN1_X_000.csv");
    folder.refused("run scene.toml", &["RSN1_X_000.csv", "No such file"]);
    folder.write(
        "ida.toml",
        "scene = \"scene.toml\"\nmeasure = \"pga\"\nlevels = [0.5]\n[records]\nfolder = \"records\"\n",
    );
    folder.refused("ida ida.toml", &["RSN1_X_000.csv", "No such file"]);
    assert!(folder.succeeds("record records").contains("RSN1_X_000.csv"));
}
