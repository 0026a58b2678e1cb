//! `rocking completions` and `rocking man`: what shells and `man` want to know of the command line.

use crate::arguments::Arguments;
use crate::error::Failure;
use crate::output;
use crate::terminal::print;
use crate::text::shown;
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use std::path::Path;

/// Prints the completion script of a shell.
pub fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "rocking", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Writes a man page for `rocking` and one for each of its commands into a folder, or prints that of `rocking`.
pub fn man(folder: Option<&Path>) -> Result<(), Failure> {
    let mut root = Arguments::command();
    root.build();
    let Some(folder) = folder else { return print(&page(root)?) };
    output::folder(folder)?;
    let mut names = vec!["rocking.1".to_string()];
    let commands: Vec<Command> =
        root.get_subcommands().filter(|command| command.get_name() != "help").cloned().collect();
    output::file(&folder.join("rocking.1"), page(root)?)?;
    for command in commands {
        let name = format!("rocking-{}", command.get_name());
        // The page is that of `man rocking-run`: the command's own name, `run`, would make it `man run`.
        let command = command.name(name.clone()).display_name(name.clone());
        names.push(format!("{name}.1"));
        output::file(&folder.join(format!("{name}.1")), page(command)?)?;
    }
    print(&format!("wrote {} to {}\n", names.join(", "), shown(folder)))
}

fn page(command: Command) -> Result<String, Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page).map_err(|error| Failure::StandardOutput(error.to_string()))?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
