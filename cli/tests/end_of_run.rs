//! The end of a run: chosen where the scene gives none, and never told as if the column stood beyond it.

use crate::common::Folder;
use crate::common::scenes::{BLOCK, LATE};

#[test]
fn a_run_without_an_end_goes_on_to_the_end_of_the_record_and_a_free_swing() {
    let folder = Folder::with("s.toml", &format!("{BLOCK}{LATE}"));
    folder.succeeds("run s.toml");
    // The ground rests from the first of the last zeros on, 14 s, and 20/p = 9.4 s are less than 10 s.
    let own = folder.summary();
    assert_eq!(own["options"]["t_end"], 24.0);
    assert_eq!(own["truncated"], false);
    let text = folder.succeeds("check s.toml");
    assert!(text.contains("solver.t_end = 24 s: the ground rests from 14 s on"), "{text}");
}

#[test]
fn a_run_that_cuts_its_record_says_so_and_not_that_the_column_stands() {
    let folder = Folder::with("s.toml", &format!("{BLOCK}{LATE}[solver]\nt_end = 5.0\n"));
    let (told, warned) = folder.says("run s.toml --report");
    assert!(told.contains("not overturned up to t = 5 s") && !told.contains("stands"), "{told}");
    assert!(warned.contains("the ground motion is cut: it lasts until t = 14.0000 s"), "{warned}");
    assert_eq!(folder.summary()["truncated"], true);
    let page = folder.page();
    assert!(page.contains("<strong>not overturned</strong>") && !page.contains("<strong>stands</strong>"));
    // The same record to its end overturns the column.
    folder.write("s.toml", format!("{BLOCK}{LATE}"));
    folder.succeeds("run s.toml");
    assert_eq!(folder.summary()["status"], "overturned");
}

#[test]
fn a_run_that_ends_while_its_column_falls_does_not_say_that_it_stands() {
    let pulse = "kind = \"sine-pulse\"\namplitude_uplift = 4.0\nomega_p = 5.0\n[restitution]\neta = 0.9\n";
    for friction in ["", "friction = 0.9\n"] {
        // It overturns at t = 3.1 s.
        let folder = Folder::with("s.toml", &format!("{friction}{BLOCK}{pulse}[solver]\nt_end = 3.0\n"));
        let (told, warned) = folder.says("run s.toml --report");
        assert!(told.contains("not determined; this run rocks; not overturned up to t = 3 s"), "{told}");
        assert!(told.contains("the column may be falling") && !told.contains("stands"), "{told}");
        assert!(warned.contains("past its balance, or with the energy to get there"), "{warned}");
        let own = folder.summary();
        assert_eq!((&own["may_overturn"], &own["truncated"]), (&true.into(), &true.into()));
        assert_eq!(own["trust"]["determined"], false);
        let page = folder.page();
        assert!(
            page.contains("The verdict is <strong>not determined</strong>")
                && page.contains("has not overturned up to")
        );
        assert!(!page.contains("<strong>stands</strong>"));
    }
}

/// At the end of the run the ground goes on shaking, and the block lies at 87°.
#[test]
fn a_column_past_its_balance_may_be_falling_though_the_ground_moves() {
    let harmonic = "kind = \"harmonic\"\namplitude_g = 0.6\nfrequency = 0.3\nduration = 20.0\n[solver]\n";
    for friction in ["", "friction = 0.9\n"] {
        let column = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\n";
        let scene = |t_end: f64| format!("{friction}{column}{harmonic}t_end = {t_end}\n");
        let folder = Folder::with("s.toml", &scene(1.58));
        let (told, warned) = folder.says("run s.toml");
        assert!(told.contains("not determined; this run rocks; not overturned up to t = 1.58 s"), "{told}");
        assert!(told.contains("the column may be falling") && !told.contains("stand"), "{told}");
        assert!(warned.contains("past its balance"), "{warned}");
        assert_eq!(folder.summary()["may_overturn"], true);
        // A little later it overturns, and a little less shaking may do so as well.
        folder.write("s.toml", scene(if friction.is_empty() { 1.6 } else { 1.63 }));
        let told = folder.succeeds("run s.toml");
        assert!(told.contains("; may overturn with 1 % less shaking"), "{told}");
        // Upright again, it stands up to the end.
        folder.write("s.toml", scene(0.5));
        assert!(folder.succeeds("run s.toml").contains("where the run ends and the ground still moves"));
        assert_eq!(folder.summary()["may_overturn"], false);
    }
}

/// A block that reaches a small overturning angle may return, and is not said to fall.
#[test]
fn an_overturning_angle_below_the_balance_is_named() {
    let pulse = "kind = \"half-sine\"\namplitude_g = 0.6\nfrequency = 2\n[solver]\noverturn_angle = 0.05\n";
    let block = "[[block]]\nhalf_width = 0.2\nhalf_height = 1.0\n[excitation.horizontal]\n";
    let folder = Folder::with("s.toml", &format!("{block}{pulse}"));
    let told = folder.succeeds("run s.toml --report");
    assert!(
        told.contains("(block 1): reaches solver.overturn_angle = 0.05 rad, below its balance; 0 impact(s)"),
        "{told}"
    );
    let page = folder.page();
    assert!(
        page.contains("reaches the overturning angle of 0.05 rad") && !page.contains("some block is past its balance")
    );
    // By default it stands.
    folder.write("s.toml", format!("{block}{pulse}").replace("[solver]\noverturn_angle = 0.05\n", ""));
    assert!(folder.succeeds("run s.toml").starts_with("rocks and stands"));
}

#[test]
fn a_motion_without_an_end_wants_one_of_its_run() {
    let harmonic = "kind = \"harmonic\"\namplitude_g = 0.3\nfrequency = 2\n";
    let folder = Folder::with("s.toml", &format!("{BLOCK}{harmonic}"));
    folder.refused("run s.toml", &["solver.t_end", "no end"]);
    folder.write("s.toml", format!("{BLOCK}{harmonic}[solver]\nt_end = 5.0\n"));
    let (told, warned) = folder.says("run s.toml");
    assert!(told.contains("the ground still moves"), "{told}");
    assert_eq!(warned, "", "it must be cut somewhere");
}

#[test]
fn rows_of_a_sweep_say_whether_they_are_cut() {
    let folder = Folder::with("s.toml", &format!("{BLOCK}{LATE}"));
    let sweep = "scene = \"s.toml\"\n[axes]\n\"solver.t_end\" = [5, 30]\nscale = [0.1, 1]\n";
    folder.write("sweep.toml", sweep);
    let told = folder.succeeds("sweep sweep.toml --out t.csv");
    assert!(told.contains("2 run(s) are cut at solver.t_end"), "{told}");
    let table = folder.table("t.csv");
    assert_eq!(table.columns().iter().rev().nth(1), Some(&"truncated"));
    assert_eq!(table.texts("truncated"), ["true", "true", "false", "false"], "{table:?}");
    // Without a given end it follows the start of the record from row to row.
    let sweep = "scene = \"s.toml\"\nask = \"peaks\"\n[axes]\nstart = [0, 100]\n";
    folder.write("sweep.toml", sweep);
    folder.succeeds("sweep sweep.toml --out t.csv");
    let table = folder.read("t.csv");
    assert_eq!(table.matches("overturns").count(), 2, "{table}");
}

/// Rows say how the column is drawn, not how it moves at the end of the run.
#[test]
fn a_run_with_few_rows_is_still_rocking() {
    let block = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[restitution]\neta = 0.9\n[excitation.horizontal]\n\
                 kind = \"sine-pulse\"\namplitude_uplift = 1.8\nomega_p = 5\nstart = 2.2\n[solver]\nt_end = 2.9\n";
    for rows in ["dt = 0.01", "dt = 2.0", "times = [0.0, 0.1]"] {
        let folder = Folder::with("s.toml", &format!("{block}[output]\n{rows}\n"));
        let told = folder.succeeds("run s.toml --out o --no-trust --report");
        assert!(
            told.contains("still rocking") && folder.read("o/report.html").contains("still rocking"),
            "{rows}: {told}"
        );
    }
}
