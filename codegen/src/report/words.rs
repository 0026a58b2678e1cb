//! Lists and counts in words. A `~` joins a noun and its number, as in LaTeX.

/// What the blocks do that turn with no link.
#[derive(Clone, Copy, Debug)]
pub enum Below {
    /// They stand on the ground.
    Stays,
    /// They may slide.
    DoesNotTurn,
}

/// Which blocks are which link, and what those `below` the lowest link do; `theta` names the angle of a link.
pub fn links_in_words(link_of_block: &[usize], below: Below, theta: impl Fn(usize) -> String) -> String {
    let of = |link: usize| positions(link_of_block, |known| *known == link);
    let mut members = Vec::new();
    let resting = of(0);
    if !resting.is_empty() {
        let does = match (below, resting.len()) {
            (Below::Stays, 1) => "stays with the ground",
            (Below::Stays, _) => "stay with the ground",
            (Below::DoesNotTurn, 1) => "does not turn",
            (Below::DoesNotTurn, _) => "do not turn",
        };
        members.push(format!("{} {does}", listed("block", &resting)));
    }
    for link in 1..=link_of_block.iter().copied().max().unwrap_or(0) {
        let blocks = of(link);
        let verb = if blocks.len() == 1 { "is" } else { "are" };
        members.push(format!("{} {verb} link {link}, turned by {}", listed("block", &blocks), theta(link)));
    }
    members.join("; ")
}

/// Numbers, from 1, of the members for which `holds`.
pub fn positions<T>(members: &[T], holds: impl Fn(&T) -> bool) -> Vec<usize> {
    members.iter().enumerate().filter(|(_, member)| holds(member)).map(|(index, _)| index + 1).collect()
}

/// `1 block`, `2 blocks`.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// `block 1`, `blocks 2 and 3`.
pub fn listed(noun: &str, numbers: &[usize]) -> String {
    let texts: Vec<String> = numbers.iter().map(usize::to_string).collect();
    format!("{noun}{}~{}", if numbers.len() == 1 { "" } else { "s" }, joined(&texts))
}

/// `a, b and c`
pub fn joined(texts: &[String]) -> String {
    match texts {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

pub fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or(String::new(), |first| first.to_uppercase().chain(characters).collect())
}
