//! Which module of a crate imports which, from the text of its files.
//!
//! A module is a file. An import is a path below `crate`, `super`, `self` or a child module, in a `use` or anywhere else in the code outside of
//! tests; `pub use` hands a name on and is followed to the file that defines it.

use std::collections::{BTreeMap, BTreeSet};

/// Names of a module below the root of its crate; none for the root.
type Module = Vec<String>;

/// The imports that lie on circles, `a -> b` each; none if there is no circle.
pub fn circle(modules: &BTreeMap<Module, String>) -> Vec<String> {
    let texts: BTreeMap<&Module, String> = modules.iter().map(|(module, text)| (module, code(text))).collect();
    let mut handed_on = BTreeMap::new();
    for (module, text) in &texts {
        for (path, name) in paths_of_uses(text, true) {
            handed_on.insert(((*module).clone(), name), absolute(module, &path, modules));
        }
    }
    let mut edges: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    for (module, text) in &texts {
        let paths = paths_of_uses(text, false).into_iter().map(|(path, _)| path).chain(paths_elsewhere(text));
        let targets = paths.filter_map(|path| target(absolute(module, &path, modules)?, modules, &handed_on));
        edges.insert((*module).clone(), targets.filter(|target| target != *module).collect());
    }
    // What imports nothing that is left, or is imported by nothing that is left, lies on no circle.
    loop {
        let left: BTreeSet<Module> = edges.keys().cloned().collect();
        let imported: BTreeSet<Module> = edges.values().flatten().cloned().collect();
        let ends = |module: &Module| edges[module].is_disjoint(&left) || !imported.contains(module);
        let ends: Vec<Module> = left.iter().filter(|module| ends(module)).cloned().collect();
        if ends.is_empty() {
            break;
        }
        ends.iter().for_each(|module| drop(edges.remove(module)));
        edges.values_mut().for_each(|targets| targets.retain(|target| !ends.contains(target)));
    }
    let arrow = |(module, targets): (&Module, &BTreeSet<Module>)| {
        let from = module.join("::");
        targets.iter().map(|target| format!("{from} -> {}", target.join("::"))).collect::<Vec<_>>()
    };
    edges.iter().flat_map(arrow).collect()
}

/// Code without comments, strings of one line, and tests.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or(line));
    lines.collect::<Vec<_>>().join("\n")
}

/// Paths of the `use` items, public ones or others, with the name under which each is known.
fn paths_of_uses(text: &str, are_public: bool) -> Vec<(Vec<String>, String)> {
    let mut found = Vec::new();
    for (start, _) in text.match_indices("use ") {
        let line = text[..start].rsplit('\n').next().unwrap_or_default().trim();
        let is_item = line.is_empty() || line.starts_with("pub") || line.ends_with(';') || line.ends_with('{');
        let Some(item) = text[start + 4..].split(';').next().filter(|_| is_item) else { continue };
        if (line.ends_with("pub") || line.ends_with(')')) == are_public {
            expand(item, &mut Vec::new(), &mut found);
        }
    }
    found
}

/// The paths of a tree of imports.
fn expand(tree: &str, above: &mut Vec<String>, found: &mut Vec<(Vec<String>, String)>) {
    let tree = tree.trim();
    if let Some((path, list)) = tree.split_once('{') {
        let count = above.len();
        above.extend(path.split("::").map(str::trim).filter(|part| !part.is_empty()).map(String::from));
        let list = list.trim_end().strip_suffix('}').unwrap_or(list);
        let (mut depth, mut start) = (0, 0);
        for (index, character) in list.char_indices().chain([(list.len(), ',')]) {
            match character {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    expand(&list[start..index], above, found);
                    start = (index + 1).min(list.len());
                }
                _ => {}
            }
        }
        above.truncate(count);
    } else if !tree.is_empty() {
        let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias.trim())));
        let mut path: Vec<String> =
            above.iter().cloned().chain(path.split("::").map(|part| part.trim().to_string())).collect();
        if path.last().is_some_and(|last| last == "self") {
            path.pop();
        }
        let name = alias.map(String::from).or_else(|| path.last().cloned()).unwrap_or_default();
        found.push((path, name));
    }
}

/// Paths below `crate` and `super` in the code itself.
fn paths_elsewhere(text: &str) -> Vec<Vec<String>> {
    let is_part = |character: char| character.is_alphanumeric() || character == '_' || character == ':';
    ["crate::", "super::"]
        .into_iter()
        .flat_map(|root| text.match_indices(root).map(|(start, _)| &text[start..]))
        .map(|rest| rest.split(|character| !is_part(character)).next().unwrap_or_default())
        .map(|path| path.split("::").filter(|part| !part.is_empty()).map(String::from).collect())
        .collect()
}

/// A path from the root of the crate; `None` if it is of another crate.
fn absolute(module: &Module, path: &[String], modules: &BTreeMap<Module, String>) -> Option<Module> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => Some(rest.to_vec()),
        "self" => Some([module.as_slice(), rest].concat()),
        "super" => {
            let parent = &module[..module.len().checked_sub(1)?];
            match rest.first() {
                Some(next) if next == "super" => absolute(&parent.to_vec(), rest, modules),
                _ => Some([parent, rest].concat()),
            }
        }
        _ => {
            let below = [module.as_slice(), path].concat();
            modules.contains_key(&below[..=module.len()]).then_some(below)
        }
    }
}

/// The file that defines what a path names.
fn target(
    mut path: Module,
    modules: &BTreeMap<Module, String>,
    handed_on: &BTreeMap<(Module, String), Option<Module>>,
) -> Option<Module> {
    for _ in 0..16 {
        let length = (0..=path.len()).rev().find(|length| modules.contains_key(&path[..*length]))?;
        let (module, rest) = path.split_at(length);
        match rest.first().and_then(|name| handed_on.get(&(module.to_vec(), name.clone()))) {
            Some(Some(next)) => path = [next.as_slice(), &rest[1..]].concat(),
            // Of another crate.
            Some(None) => return None,
            None => return Some(module.to_vec()),
        }
    }
    None
}
