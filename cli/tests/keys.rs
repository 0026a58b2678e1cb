//! The reference of keys has what the reader takes, and nothing else.

use crate::common::{Folder, assert_has, project_text};
use rocking::scene_file::keys_asked_by;
use serde_json::Value;
use std::collections::BTreeSet;

/// The dotted keys of a schema, without places in lists; tables within a term of a sum are those of a component.
fn keys_of(schema: &Value) -> BTreeSet<String> {
    keys_within(schema, schema)
}

/// The same of a part of a schema.
fn keys_within(schema: &Value, part: &Value) -> BTreeSet<String> {
    fn walk(root: &Value, value: &Value, path: &str, keys: &mut BTreeSet<String>) {
        if let Some(reference) = value.get("$ref").and_then(Value::as_str) {
            return walk(root, root.pointer(reference.trim_start_matches('#')).expect("a definition"), path, keys);
        }
        for part in ["anyOf", "oneOf"]
            .iter()
            .filter_map(|key| value.get(*key))
            .flat_map(|parts| parts.as_array().expect("a list"))
        {
            walk(root, part, path, keys);
        }
        if let Some(items) = value.get("items") {
            walk(root, items, path, keys);
        }
        for (name, own) in value.get("properties").and_then(Value::as_object).into_iter().flatten() {
            let below = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
            if keys.insert(below.clone()) && name != "term" {
                walk(root, own, &below, keys);
            }
        }
    }
    let mut keys = BTreeSet::new();
    walk(schema, part, "", &mut keys);
    keys
}

fn schema(kind: &str) -> Value {
    Folder::new().answers(&format!("keys {kind} --schema"))
}

/// A key as the schema has it: no places in lists.
fn plain(key: &str) -> String {
    let parts = key.split('.').map(|part| part.split('[').next().unwrap_or_default());
    let plain = parts.collect::<Vec<_>>().join(".");
    plain.replace(".term.", ".")
}

const COLUMN: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n";

/// Scenes that lead the reader everywhere.
fn scenes() -> Vec<String> {
    let wave = "amplitude = 1\nomega = 3\n";
    let kinds = [
        ("sine-pulse", wave),
        ("cosine-pulse", wave),
        ("half-sine", wave),
        ("type-c", "amplitude = 1\nomega = 3\ncycles = 2\n"),
        ("ricker", wave),
        ("antisymmetric-ricker", wave),
        ("mavroeidis-papageorgiou", "velocity = 1\nomega = 3\ngamma = 2\n"),
        ("gabor", "velocity = 1\nomega = 3\ngamma = 2\n"),
        ("rectangular", "amplitude = 1\nduration = 1\n"),
        ("double-rectangular", "amplitude = 1\nduration = 1\n"),
        ("harmonic", "amplitude = 1\nomega = 3\nduration = 2\n"),
        ("synthetic", "pga = 1\n"),
        ("record", "accel = [0, 1, 0]\ndt = 0.1\n"),
    ];
    let mut scenes = vec![format!(
        "{COLUMN}[size]\nalpha = 0.2\n[friction]\nstatic = 0.5\n[restitution]\neta = 0.9\n[initial]\ntheta = [0.1]\n[solver]\nt_end = 1\n[output]\ndt = 0.1\n"
    )];
    scenes.push(format!("{COLUMN}[solver]\nt_end = 1\n[output]\ntimes = [0, 0.5]\n"));
    scenes.push(format!("{COLUMN}[excitation.station]\nrecord = \"../ground/tests/records/peer/RSN9001\"\n"));
    scenes.push(
        "friction = 0.5\n[[block]]\nwidth = 0.8\nheight = 1\ndepth = 0.8\n[[block]]\ndiameter = 0.8\nheight = 1\n"
            .into(),
    );
    for (kind, keys) in kinds {
        for component in ["horizontal", "vertical"] {
            scenes.push(format!("{COLUMN}[excitation.{component}]\nkind = \"{kind}\"\n{keys}"));
            scenes.push(format!(
                "{COLUMN}[excitation.{component}]\nkind = \"sum\"\n[[excitation.{component}.term]]\nkind = \"{kind}\"\n{keys}"
            ));
        }
    }
    scenes
}

fn assert_same(kind: &str, asked: &BTreeSet<String>) {
    let known = keys_of(&schema(kind));
    let unknown: Vec<&String> = asked.difference(&known).collect();
    assert!(unknown.is_empty(), "the reader takes these keys, and cli/src/keys/ does not know them: {unknown:?}");
    let unread: Vec<&String> = known.difference(asked).collect();
    assert!(unread.is_empty(), "cli/src/keys/ has these keys, and no reader asks for them: {unread:?}");
    assert!(known.len() > 10, "{known:?}");
}

/// The values that a definition of the schema of scenes may have.
fn values_of(definition: &str) -> BTreeSet<String> {
    let schema = schema("scene");
    let values = schema["$defs"][definition]["enum"].as_array().expect("a list of values");
    values.iter().map(|value| value.as_str().expect("a text").to_owned()).collect()
}

/// Chapters of the book, joined.
fn chapters(names: &[&str]) -> String {
    names.iter().map(|name| project_text(&format!("docs/book/{name}.md"))).collect()
}

/// Whether a chapter names this in a table or in the text, or gives it a value in an example.
fn is_named(chapters: &str, name: &str) -> bool {
    [format!("`{name}`"), format!(" {name} = ")].iter().any(|text| chapters.contains(text))
}

#[test]
fn the_book_names_every_key_every_method_and_every_kind_of_motion() {
    for (kind, names) in [
        ("scene", &["scene-file", "ground-motion"][..]),
        ("sweep", &["sweeps"]),
        ("study", &["fragility", "scene-file", "ground-motion"]),
    ] {
        let chapters = chapters(names);
        let keys = keys_of(&schema(kind));
        assert!(keys.len() > 10, "{kind}: {keys:?}");
        let is_table = |key: &String| keys.iter().any(|other| other.starts_with(&format!("{key}.")));
        for key in keys.iter().filter(|key| !is_table(key)) {
            let name = key.rsplit('.').next().unwrap_or_default();
            assert!(is_named(&chapters, name), "{names:?} do not name the key `{key}` of a {kind}");
        }
    }
    for kind in values_of("Kind") {
        let is_there = is_named(&chapters(&["ground-motion", "scene-file"]), &kind);
        assert!(is_there, "ground-motion.md and scene-file.md have no kind `{kind}`");
    }
    for method in rocking::Method::ALL {
        for chapter in ["methods", "scene-file"] {
            assert!(is_named(&chapters(&[chapter]), method.name()), "{chapter}.md has no method `{}`", method.name());
        }
    }
}

/// Tables of a summary whose fields the chapters do not list: inputs as understood, counts of work, times by names of modes.
const UNLISTED: [&str; 6] = ["scene", "options", "column", "excitation", "work", "time_in_mode"];

/// The names of fields in a summary, those of tables within it as well.
fn fields(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Object(table) => {
            for (name, own) in table {
                names.insert(name.clone());
                if !UNLISTED.contains(&name.as_str()) {
                    fields(own, names);
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|own| fields(own, names)),
        _ => {}
    }
}

#[test]
fn the_book_names_every_field_of_a_summary() {
    let folder = Folder::new();
    let column = "[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.2\n[excitation.horizontal]\nkind = \"sine-pulse\"\n\
                  amplitude_uplift = 2\nomega_p = 4\n[solver]\nt_end = 6\n";
    let mut names = BTreeSet::new();
    for head in ["", "friction = 0.3\n", "[restitution]\neta = 0.9\n"] {
        folder.write("scene.toml", format!("{head}{column}"));
        folder.succeeds("run scene.toml");
        fields(&folder.summary(), &mut names);
    }
    let chapters = chapters(&["results", "trust", "scene-file"]);
    let missing: Vec<&String> = names.iter().filter(|name| !is_named(&chapters, name)).collect();
    assert!(
        missing.is_empty(),
        "results.md, trust.md and scene-file.md do not name these fields of summary.json: {missing:?}"
    );
    assert!(names.len() > 60, "{names:?}");
}

#[test]
fn the_schema_of_scenes_has_every_method_and_every_kind_of_motion() {
    let methods = values_of("Method");
    for method in rocking::Method::ALL {
        assert!(methods.contains(method.name()), "cli/src/keys/scene.rs does not know the method `{}`", method.name());
    }
    let scene = format!("{COLUMN}[excitation.horizontal]\nkind = \"none\"\n");
    let error = rocking::Scene::from_toml(&scene, "s.toml".as_ref()).expect_err("there is no such kind").to_string();
    let (_, kinds) = error.split_once("choose one of ").expect("a list of kinds");
    let known = values_of("Kind");
    let names: Vec<&str> = kinds.split(',').map(|name| name.split_whitespace().next().unwrap_or_default()).collect();
    assert!(names.len() > 10, "{error}");
    let scenes = scenes();
    for name in names {
        assert!(known.contains(name), "cli/src/keys/motion.rs does not know the kind `{name}`");
        let is_of_kind = |scene: &String| scene.contains(&format!("kind = \"{name}\""));
        assert!(scenes.iter().any(is_of_kind), "the scenes of this test have no `{name}`: its keys are not compared");
    }
}

#[test]
fn the_schema_of_scenes_has_the_keys_that_the_reader_takes() {
    let mut asked = BTreeSet::new();
    for scene in scenes() {
        let (read, keys) = keys_asked_by(|| rocking::Scene::from_toml(&scene, "s.toml".as_ref()).map_err(Box::new));
        read.unwrap_or_else(|error| panic!("{error}\n{scene}"));
        asked.extend(keys.iter().map(|key| plain(key)));
    }
    assert_same("scene", &asked);
}

#[test]
fn the_schemas_of_sweeps_and_studies_have_the_keys_that_their_readers_take() {
    let folder = Folder::with(
        "s.toml",
        &format!("{COLUMN}[excitation.horizontal]\nkind = \"ricker\"\namplitude = 1\nperiod = 1\n"),
    );
    folder.write(
        "sweep.toml",
        "scene = \"s.toml\"\n[axes]\namplitude = { from = 1, to = 2 }\nrtol = { from = 1e-9, to = 1e-6, steps = 3, scale = \"log\" }\n",
    );
    let (read, mut asked) = keys_asked_by(|| rocking::Sweep::from_file(&folder.path("sweep.toml")).map_err(Box::new));
    read.expect("valid");
    folder.write(
        "sampled.toml",
        "scene = \"s.toml\"\n[axes]\neta = { normal = [0.9, 0.01] }\namplitude = { lognormal = [1, 0.2] }\nrtol = { uniform = [1e-9, 1e-8] }\n\
        gravity = { discrete = [9.8, 9.9] }\n[sampling]\nsamples = 4\ncorrelations = [{ axes = [\"eta\", \"amplitude\"], value = 0.5 }]\n",
    );
    let (read, sampled) = keys_asked_by(|| rocking::Sweep::from_file(&folder.path("sampled.toml")).map_err(Box::new));
    read.expect("valid");
    // Of the keys of the base scene, which is read as well, none is of the sweep; those of a range stand below any axis.
    asked.retain(|key| {
        ["scene", "combine", "ask", "axes", "sampling"].contains(&key.as_str()) || key.starts_with("axes.")
    });
    let ranges: BTreeSet<String> =
        asked.iter().filter_map(|key| key.strip_prefix("axes.amplitude.")).map(String::from).collect();
    let own = schema("sweep");
    let definition = |name: &str| keys_within(&own, &own["$defs"][name]);
    assert_eq!(ranges, definition("Range"));
    assert_eq!(definition("Folder"), BTreeSet::from(["folder".to_string()]));
    let top = |keys: &BTreeSet<String>| keys.iter().filter(|key| !key.contains('.')).cloned().collect::<BTreeSet<_>>();
    let within = |keys: &BTreeSet<String>, above: &str| {
        keys.iter().filter_map(|key| plain(key).strip_prefix(above).map(String::from)).collect::<BTreeSet<String>>()
    };
    let distribution: BTreeSet<String> = ["eta", "amplitude", "rtol", "gravity"]
        .iter()
        .flat_map(|axis| within(&sampled, &format!("axes.{axis}.")))
        .collect();
    assert_eq!(distribution, definition("Distribution"));
    assert_eq!(within(&sampled, "sampling."), definition("Sampling"));
    let properties = own["properties"].as_object().expect("keys").keys().cloned().collect::<BTreeSet<_>>();
    assert_eq!(top(&asked), properties);

    folder.write(
        "study.toml",
        "scene = \"s.toml\"\nmeasure = \"sa\"\nsa_period = 1\nlevels = { from = 1, to = 2 }\n[records.synthetic]\nseeds = { from = 1, to = 2 }\n\
        [fragility]\nstates = [\"uplift\"]\n",
    );
    let (read, asked) =
        keys_asked_by(|| rocking::studies::IdaFile::from_file(&folder.path("study.toml")).map_err(Box::new));
    read.expect("valid");
    let known = keys_of(&schema("study"));
    let of_study = |key: &String| {
        let top = key.split('.').next().unwrap_or_default();
        let own =
            ["scene", "measure", "sa_period", "sa_damping", "levels", "free_swing", "trust", "records", "fragility"];
        own.contains(&top) && !key.starts_with("scene.")
    };
    // Refused with its remedy, and so asked for.
    let known: BTreeSet<String> = known.into_iter().filter(of_study).collect();
    let mut asked: BTreeSet<String> = asked.into_iter().filter(of_study).collect();
    asked.remove("records.synthetic.seed");
    assert_eq!(asked, known);
}

#[test]
fn the_list_has_units_and_defaults() {
    let text = Folder::new().succeeds("keys scene");
    for line in ["[solver]", "[[block]]", "[excitation.horizontal]"] {
        assert!(text.lines().any(|own| own == line), "{line}: {text}");
    }
    let line = |key: &str| {
        text.lines()
            .find(|line| line.trim_start().starts_with(&format!("{key} ")))
            .unwrap_or_else(|| panic!("{key}: {text}"))
    };
    assert!(
        line("stick_angle").contains("number ≥ 1e-14, ≤ 0.01")
            && line("stick_angle").contains("rad")
            && line("stick_angle").ends_with("default: 1e-9"),
        "{}",
        line("stick_angle")
    );
    assert!(line("shape").contains("prism | drum"), "{}", line("shape"));
    assert!(line("blocks").ends_with("default: required"), "{}", line("blocks"));
    assert!(line("accel").contains("list of numbers"));
    // Long choices stand behind the meaning: a column as wide as they are would push all other meanings off the screen.
    assert!(
        line("kind").starts_with("  kind              a name ")
            && line("kind").contains("`record`: sine-pulse | one-sine")
    );
    assert!(line("pga_g").chars().count() < 120, "{}", line("pga_g"));
    let sweep = Folder::new().succeeds("keys sweep");
    for heading in
        ["[axes.KEY] a range of numbers", "[axes.KEY] the files of a folder", "[axes.KEY] a distribution: one of"]
    {
        assert!(sweep.lines().any(|own| own.starts_with(heading)), "{heading}: {sweep}");
    }
    assert!(sweep.lines().any(|own| own.starts_with("  lognormal ")), "{sweep}");
    let all = Folder::new().succeeds("keys");
    assert_has(&all, &["Study files", "Sweep files", "[fragility]"]);
}
