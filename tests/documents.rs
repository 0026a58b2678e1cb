//! The documents hold what they say of the project: sections that comments cite, links, file names, commands, keys of scenes,
//! figures of benchmarks.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files below a folder whose names end in `.extension`, in the order of their paths; none if the folder does not exist.
fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![root().join(folder)]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("readable").path();
            if path.is_dir() && !path.ends_with("target") {
                folders.push(path);
            } else if path.extension().is_some_and(|own| own == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// README, CONTRIBUTING and the chapters of the book, with their texts.
fn documents() -> Vec<(PathBuf, String)> {
    let mut paths = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    paths.extend(files("docs/book", "md"));
    assert!(paths.len() > 10, "the book has chapters");
    paths.into_iter().map(|path| (path.clone(), read(&path))).collect()
}

/// A document in its two kinds of text: prose with inline code in backticks, and the lines of fenced blocks.
fn split(text: &str) -> (String, Vec<&str>) {
    let (mut prose, mut fenced, mut is_fenced) = (String::new(), Vec::new(), false);
    for line in text.lines() {
        if line.starts_with("```") {
            is_fenced = !is_fenced;
        } else if is_fenced {
            fenced.push(line);
        } else {
            prose.push_str(line);
            prose.push('\n');
        }
    }
    assert!(!is_fenced, "a fenced block is not closed");
    (prose, fenced)
}

/// Inline code of prose, and what stands between.
fn inline_code(prose: &str) -> (Vec<&str>, String) {
    let parts: Vec<&str> = prose.split('`').collect();
    assert!(parts.len() % 2 == 1, "a backtick has no partner");
    let code = parts.iter().skip(1).step_by(2).copied().collect();
    (code, parts.iter().step_by(2).copied().collect::<Vec<_>>().join(" "))
}

/// Headings with their level, backticks removed.
fn headings(text: &str) -> Vec<String> {
    let (prose, _) = split(text);
    let title = |line: &str| line.starts_with('#').then(|| line.trim_start_matches('#').trim().replace('`', ""));
    prose.lines().filter_map(title).collect()
}

/// The anchor that GitHub and mdBook give a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>();
    kept.replace(' ', "-")
}

/// The whole number at the head of a text, and the rest.
fn leading_number(text: &str) -> Option<(usize, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    Some((text[..end].parse().ok()?, &text[end..]))
}

/// Sections of the model that a source cites, each with the item if one is named.
fn citations(source: &str) -> Vec<(usize, Option<usize>)> {
    let bare = |line: &str| line.trim().trim_start_matches('/').trim_start_matches('!').trim().to_lowercase();
    let text = source.lines().map(bare).collect::<Vec<_>>().join(" ").replace('`', "");
    let mut found = Vec::new();
    for after in text.split("model.md").skip(1) {
        let after = after.trim_start_matches([',', ' ']);
        let Some(after) = after.strip_prefix("sections ").or_else(|| after.strip_prefix("section ")) else { continue };
        let Some((section, mut rest)) = leading_number(after) else { panic!("no number of a section: {after:.40}") };
        found.push((section, None));
        let separators = [" and ", " to ", ", "];
        while let Some((section, after)) =
            separators.iter().find_map(|separator| leading_number(rest.strip_prefix(separator)?))
        {
            found.push((section, None));
            rest = after;
        }
        if let Some((item, _)) = rest.strip_prefix(", item ").and_then(leading_number) {
            found.last_mut().expect("a section").1 = Some(item);
        }
    }
    found
}

#[test]
fn citations_are_read_in_all_their_forms() {
    assert_eq!(citations("//! (docs/book/model.md, section 5, item 3)."), [(5, Some(3))]);
    assert_eq!(citations("/// `docs/book/model.md`, section 4."), [(4, None)]);
    assert_eq!(citations("// see model.md\n// sections 4 and 5: a"), [(4, None), (5, None)]);
    assert_eq!(citations("/// MODEL.md leaves it out."), []);
}

#[test]
fn every_section_that_a_comment_cites_is_in_the_model() {
    let model = read(&root().join("docs/book/model.md"));
    let sections: Vec<(usize, Vec<usize>)> = model
        .split("\n## ")
        .filter_map(|section| {
            let (number, rest) = leading_number(section)?;
            rest.strip_prefix(". ").expect("`## N. Title`");
            let items = rest.lines().filter_map(|line| Some((leading_number(line)?.0, line)));
            Some((number, items.filter(|(item, line)| line.starts_with(&format!("{item}. "))).map(|i| i.0).collect()))
        })
        .collect();
    let numbers: Vec<usize> = sections.iter().map(|(number, _)| *number).collect();
    assert_eq!(numbers, (1..=sections.len()).collect::<Vec<_>>(), "sections are numbered without gaps");
    let mut cited = 0;
    for folder in ["codegen", "solver", "ground", "cli", "tests", "benches"] {
        for file in files(folder, "rs").into_iter().filter(|file| !file.ends_with(file!())) {
            for (section, item) in citations(&read(&file)) {
                let found = sections.iter().find(|(number, _)| *number == section);
                let (_, items) = found.unwrap_or_else(|| panic!("{} cites section {section}", file.display()));
                let has_item = item.is_none_or(|item| items.contains(&item));
                assert!(has_item, "{} cites section {section}, item {item:?}", file.display());
                cited += 1;
            }
        }
    }
    assert!(cited >= 30, "{cited} citations: the pattern finds them");
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let mut links = 0;
    for (path, text) in documents() {
        let (prose, _) = split(&text);
        let (_, plain) = inline_code(&prose);
        for target in plain.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if target.starts_with("https://") {
                continue;
            }
            let (file, heading) =
                target.split_once('#').map_or((target, None), |(file, heading)| (file, Some(heading)));
            let linked = if file.is_empty() { path.clone() } else { path.with_file_name("").join(file) };
            assert!(linked.exists(), "{}: {target} does not exist", path.display());
            if let Some(heading) = heading {
                let found = headings(&read(&linked)).iter().any(|own| anchor(own) == heading);
                assert!(found, "{}: {target} has no such heading", path.display());
            }
            links += 1;
        }
    }
    assert!(links > 40, "{links} links: the pattern finds them");
}

#[test]
fn the_readme_is_short() {
    let lines = read(&root().join("README.md")).lines().count();
    assert!(lines <= 160, "{lines} lines; move what is too long to docs/book");
}

/// Words in code that are paths of the project: those with an ending of `ENDINGS` in documents for those who change the code, and
/// those that begin with a folder of the project everywhere.
#[test]
fn every_file_that_a_document_names_exists() {
    const ENDINGS: [&str; 3] = [".rs", ".toml", ".sh"];
    const FOLDERS: [&str; 9] =
        ["benches/", "cli/", "codegen/", "docs/", "examples/", "ground/", "scenes/", "solver/", "tests/"];
    let mut named = 0;
    for (path, text) in documents() {
        let is_for_developers =
            ["CONTRIBUTING.md", "architecture.md", "extending.md"].iter().any(|own| path.ends_with(own));
        let (prose, fenced) = split(&text);
        let (code, _) = inline_code(&prose);
        for word in code.into_iter().chain(fenced).flat_map(str::split_whitespace) {
            let word = word.trim_matches(|c: char| "(),;:\"'".contains(c));
            let is_path = !word.contains(['*', '$', '{']);
            let has_ending = ENDINGS.iter().any(|ending| word.ends_with(ending));
            let in_folder = FOLDERS.iter().any(|folder| word.starts_with(folder));
            if is_path && (in_folder || is_for_developers && has_ending) {
                assert!(root().join(word).exists(), "{}: {word} does not exist", path.display());
                named += 1;
            }
        }
    }
    assert!(named > 60, "{named} names: the pattern finds them");
}

#[test]
fn the_summary_lists_every_chapter_once() {
    let summary = read(&root().join("docs/book/SUMMARY.md"));
    for chapter in files("docs/book", "md") {
        let name = chapter.file_name().expect("a file").to_string_lossy().into_owned();
        let listed = summary.matches(&format!("]({name})")).count();
        assert_eq!(listed, usize::from(name != "SUMMARY.md"), "{name}");
    }
}

/// Every `rocking COMMAND` and every `--option` behind it, against the text of the command line's arguments.
#[test]
fn every_command_that_a_document_shows_exists() {
    let arguments = read(&root().join("cli/src/arguments.rs"));
    let (_, commands) = arguments.split_once("pub enum Command {\n").expect("the commands");
    let commands = commands.split("\n}").next().expect("an end");
    let variant = |line: &str| {
        let name = line.strip_prefix("    ").filter(|name| name.starts_with(|c: char| c.is_ascii_uppercase()))?;
        Some(name.split(|c: char| !c.is_alphanumeric()).next()?.to_lowercase())
    };
    let mut known: BTreeSet<String> = commands.lines().filter_map(variant).collect();
    assert!(known.contains("run") && known.len() > 8, "{known:?}");
    known.insert("help".into());
    let mut shown = BTreeSet::new();
    for (path, text) in documents() {
        let (prose, fenced) = split(&text);
        let (code, _) = inline_code(&prose);
        for line in code.into_iter().chain(fenced) {
            // The package of this name in Python.
            let line = line.replace("cargo run --release -- ", "rocking ").replace("import rocking as", "");
            for call in line.split("rocking ").skip(1) {
                let mut words = call.split('|').next().unwrap_or("").split_whitespace();
                let Some(command) = words.next().filter(|word| word.chars().all(|c| c.is_ascii_lowercase())) else {
                    continue;
                };
                assert!(known.contains(command), "{}: rocking {command}", path.display());
                for option in words.filter_map(|word| word.strip_prefix("--")).filter(|option| !option.is_empty()) {
                    let option = option.trim_end_matches(|c: char| !c.is_ascii_alphabetic());
                    let field = format!("{}:", option.replace('-', "_"));
                    assert!(arguments.contains(&field), "{}: rocking {command} --{option}", path.display());
                }
                shown.insert(command.to_string());
            }
        }
    }
    let missing: Vec<&String> = known.difference(&shown).collect();
    assert!(missing.is_empty(), "no document shows {missing:?}");
}

#[test]
fn every_example_that_a_document_or_a_script_runs_exists() {
    let scripts = files("benches", "sh").into_iter().map(|path| (path.clone(), read(&path)));
    let mut count = 0;
    for (path, text) in documents().into_iter().chain(scripts) {
        for call in text.split("--example ").skip(1) {
            let name: String = call.chars().take_while(|c| c.is_ascii_alphanumeric() || "_-".contains(*c)).collect();
            let folders = ["examples", "codegen/examples", "ground/examples", "cli/examples"];
            let is_there = |folder: &&str| root().join(folder).join(format!("{name}.rs")).is_file();
            assert!(folders.iter().any(is_there), "{}: --example {name}", path.display());
            count += 1;
        }
    }
    assert!(count > 1, "{count} examples");
}

/// Keys in the first columns of the reference's tables are keys that the reader knows, and the other way round.
#[test]
fn the_reference_of_scene_files_has_all_keys() {
    let sources: String = files("solver", "rs")
        .iter()
        .filter(|path| {
            ["scene_file", "solver/sweep", "solver/studies"].iter().any(|part| path.to_string_lossy().contains(part))
        })
        .map(|path| read(path).split("#[cfg(test)]").next().unwrap_or_default().to_string())
        .collect();
    let mut documented = BTreeSet::new();
    for chapter in ["scene-file.md", "sweeps.md", "fragility.md"] {
        let text = read(&root().join("docs/book").join(chapter));
        let (mut is_keys, mut lines) = (false, text.lines().peekable());
        while let Some(line) = lines.next() {
            let Some(row) = line.strip_prefix("| ") else { continue };
            let cell = row.split(" | ").next().unwrap_or_default();
            if lines.peek().is_some_and(|next| next.starts_with("|---")) {
                is_keys = cell == "key";
            } else if is_keys {
                documented.extend(cell.split('`').skip(1).step_by(2).map(String::from));
            }
        }
    }
    for key in &documented {
        assert!(sources.contains(&format!("\"{key}\"")), "the reader of scenes does not know `{key}`");
    }
    let calls = ["text", "number", "numbers", "positive", "whole", "flag", "name", "table", "tables"];
    // Parts of an axis, and tables that have a heading rather than a row.
    let elsewhere = [
        "from",
        "to",
        "steps",
        "folder",
        "block",
        "column",
        "restitution",
        "excitation",
        "initial",
        "solver",
        "output",
        "size",
        "station",
    ];
    // As arguments of the table's readers, and in lists of keys with their places or conversions.
    let mut patterns: Vec<(String, &str)> = calls.iter().map(|call| (format!(".{call}(\""), "")).collect();
    patterns.push(("(\"".into(), "\", &"));
    let mut asked = 0;
    for (before, after) in &patterns {
        for rest in sources.split(before.as_str()).skip(1) {
            let key = rest.split('"').next().unwrap_or_default();
            if rest[key.len()..].starts_with(after) {
                let is_documented = documented.contains(key) || elsewhere.contains(&key);
                assert!(is_documented, "docs/book/scene-file.md does not list `{key}`");
                asked += 1;
            }
        }
    }
    assert!(asked > 25 && documented.len() > 50, "{asked} and {}: the patterns find them", documented.len());
}

/// Cells of the tables between a heading of the chapter on performance and the next one, without heads and rules.
fn measured(heading: &str) -> Vec<Vec<String>> {
    let text = read(&root().join("docs/book/performance.md"));
    let (_, section) = text.split_once(&format!("## {heading}\n")).expect("a section");
    let rows = section.split("\n## ").next().unwrap_or_default().lines().filter(|line| line.starts_with("| "));
    let cells = |row: &str| row.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect::<Vec<_>>();
    let rows: Vec<Vec<String>> = rows.map(cells).filter(|row| row.iter().any(|cell| number(cell).is_some())).collect();
    assert!(!rows.is_empty(), "{heading} has a table");
    rows
}

/// The number at the head of a cell, and how far off rounding may be.
fn number(cell: &str) -> Option<(f64, f64)> {
    let end = cell.find(|c: char| !(c.is_ascii_digit() || ".,".contains(c))).unwrap_or(cell.len());
    let digits = cell[..end].trim_end_matches(',').replace(',', "");
    let value: f64 = digits.parse().ok()?;
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Some((value, (0.501 * 0.1f64.powi(decimals as i32)).max(if decimals == 0 { 0.005 * value } else { 0.0 })))
}

fn shows(cell: &str, value: f64) -> bool {
    number(cell).is_some_and(|(shown, rounding)| (shown - value).abs() <= rounding)
}

/// Rows of a table of figures by the names of its columns.
fn figures(file: &str) -> Vec<BTreeMap<String, String>> {
    let cells = |line: &str| {
        // Commas in quotes are no separators.
        let parts: Vec<String> = line
            .split('"')
            .enumerate()
            .map(|(i, part)| if i % 2 == 1 { part.replace(',', ";") } else { part.into() })
            .collect();
        parts.concat().split(',').map(String::from).collect::<Vec<_>>()
    };
    let text = read(&root().join(file));
    let mut lines = text.lines();
    let names = cells(lines.next().expect("a head"));
    lines.map(|line| names.iter().cloned().zip(cells(line)).collect()).collect()
}

fn value(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or(f64::NAN)
}

#[test]
fn tables_of_performance_show_the_figures_of_record() {
    let sweeps = figures("docs/sweeps.csv");
    for row in measured("Sweeps") {
        for (cell, column, threads) in [(1, "scenes_per_s", "1"), (2, "scenes_per_s", "2"), (3, "speed_up", "2")] {
            let of_row =
                |figure: &&BTreeMap<String, String>| figure["blocks"] == row[0] && figure["threads"] == threads;
            let figure = sweeps.iter().find(of_row).expect("a figure");
            assert!(shows(&row[cell], value(figure, column)), "{row:?}: {figure:?}");
        }
    }
    let (skips, mut skip) = (figures("docs/skips.csv"), String::new());
    for row in measured("What a run leaves out") {
        let columns = [(2, "with_us"), (3, "without_us"), (4, "ratio")];
        if !row[0].is_empty() {
            skip.clone_from(&row[0]);
        }
        // The table may add a remark in brackets.
        let scene = row[1].split(" (").next().unwrap_or_default().replace(',', ";");
        let is_shown = |figure: &BTreeMap<String, String>| {
            (&figure["skip"], &figure["scene"]) == (&skip, &scene)
                && columns.iter().all(|(i, name)| shows(&row[*i], value(figure, name)))
        };
        assert!(skips.iter().any(is_shown), "{row:?} is not in docs/skips.csv");
    }
    let peers = figures("benches/peers/peers.csv");
    let mut scene = String::new();
    for row in measured("Against others") {
        if !row[0].is_empty() {
            scene = row[0].split(" (").next().unwrap_or_default().replace(',', ";");
        }
        let error: f64 = row[1].parse().expect("an error");
        for (cell, is_ours) in [(2, true), (3, false)].into_iter().filter(|(cell, _)| !row[*cell].is_empty()) {
            let is_meant = |figure: &&BTreeMap<String, String>| {
                figure["scene"] == scene
                    && (figure["program"] == "rocking") == is_ours
                    && !(is_ours && figure["method"] == "gauss") // the deleted collocation of one mode by itself
                    && value(figure, "error") <= error
            };
            let times = peers.iter().filter(is_meant).map(|figure| value(figure, "time_us"));
            let least = times.fold(f64::INFINITY, f64::min);
            assert!(shows(&row[cell], least), "{row:?}: {least}");
        }
    }
    let precision = figures("docs/work-precision.csv");
    let errors: Vec<_> = measured("Run time against error").into_iter().filter(|row| row.len() == 4).collect();
    assert_eq!(errors.len(), 7);
    for row in errors {
        for (cell, method) in ["dop853", "dormand-prince54", "taylor"].into_iter().enumerate() {
            let scene = row[0].replace(',', ";");
            let of_cell = |figure: &&BTreeMap<String, String>| {
                let tolerance = value(figure, "rtol_or_step");
                figure["scene"] == scene
                    && figure["method"] == method
                    && figure["dynamics"] == "generated"
                    && tolerance > 0.9e-11
            };
            let over =
                |figure: &BTreeMap<String, String>| value(figure, "angle_error_rad") / value(figure, "rtol_or_step");
            let worst = precision.iter().filter(of_cell).map(over).fold(0.0, f64::max);
            assert!(shows(&row[cell + 1], worst), "{row:?}: {method} {worst}");
        }
    }
}
