//! Provenance of a run: version, method and tolerances, and the command that repeats it.

use crate::number::counted;
use crate::plot::output_times;
use crate::report::html::definitions;
use crate::report::number::{degrees, significant};
use crate::text::{escape, shell_word};
use rocking::ModeName;
use rocking::run_folder::Results;

/// The provenance of a run.
pub fn provenance(results: &Results) -> String {
    let (response, options) = (&results.response, &results.options);
    let generic = options.dynamics == "generic";
    let dynamics = match options.dynamics.as_str() {
        "generated" if response.used_generic => {
            "generated at build time; generic ones for modes that the build has not got".into()
        }
        "generated" => "generated at build time".into(),
        "generic" => "generic: hand-written, for any number of blocks".into(),
        _ => "supplied by the calling program".to_string(),
    };
    let modes = response.time_in_mode.keys().filter(|mode| **mode != ModeName::Rest).count();
    let interval = output_times(&results.response.samples);
    let rows = [
        ("Version", format!("rocking {}", escape(&results.version))),
        ("Method", format!("<code>{}</code>", escape(&results.method))),
        ("Relative tolerance", significant(options.rtol, 3)),
        ("Absolute tolerance", format!("{} rad, rad/s", significant(options.atol, 3))),
        (
            "Stick angle",
            format!("{} rad: an interface that would hop by less closes", significant(options.stick_angle, 3)),
        ),
        (
            "Overturning angle",
            format!("{} rad = {}", significant(options.overturn_angle, 5), degrees(options.overturn_angle)),
        ),
        ("Equations", format!("{dynamics}; {} entered", counted(modes, ["mode", "modes"]))),
        ("Output", interval),
    ];
    definitions(&rows) + &repetition(results, generic)
}

/// How to repeat the run and its page.
fn repetition(results: &Results, generic: bool) -> String {
    let file = results.scene.file.display().to_string();
    // Programs name a scene without a file `<scene>`.
    if file.is_empty() || file.starts_with('<') {
        return "<p>A program made this run, from a scene that no file has, or that its file had no longer: no command repeats it.</p>\n".into();
    }
    let flag = if generic { " --dynamics generic" } else { "" };
    format!(
        "<p>To repeat the run and this page:</p>\n<pre tabindex=\"0\">rocking run {}{flag} --out out --report</pre>\n",
        escape(&shell_word(&file))
    )
}
