//! Sizes: blocks by whole or half lengths, columns scaled to a slenderness and a size.

use crate::common::scenes::{BLOCK, LATE};
use crate::common::{Folder, assert_has};

#[test]
fn a_column_of_any_kind_is_scaled_to_a_slenderness_and_a_size() {
    let drums = "[[block]]\ndiameter = 0.9\nheight = 1.0\nname = \"base\"\n[[block]]\nbottom_diameter = 0.8\ntop_diameter = 0.6\nheight = 1.2\ncentroid_height = 0.7\n\
        [[block]]\nwidth = 0.5\nheight = 0.4\nmass = 300\ninertia = 20\n";
    for (size, wanted) in [
        ("alpha = 0.2\np = 1.5", (Some(0.2), Some(1.5), None)),
        ("alpha = 0.15\nR = 4.0", (Some(0.15), None, Some(4.0))),
        ("p = 3.0", (None, Some(3.0), None)),
        ("alpha = 0.1\nrocking_period = 4.0", (Some(0.1), Some(std::f64::consts::TAU / 4.0), None)),
        ("alpha = 0.3", (Some(0.3), None, None)),
    ] {
        let scene = rocking::Scene::from_toml(&format!("{drums}[size]\n{size}\n"), "s.toml".as_ref()).expect("valid");
        let plain = rocking::Scene::from_toml(drums, "s.toml".as_ref()).expect("valid");
        let (own, before) = (scene.column.stack(0), plain.column.stack(0));
        let is = |value: f64, wanted: Option<f64>| wanted.is_none_or(|wanted| (value / wanted - 1.0).abs() < 1e-12);
        assert!(is(own.slenderness(), wanted.0.or(Some(before.slenderness()))), "{size}");
        assert!(is(own.frequency_parameter(), wanted.1) && is(own.radius(), wanted.2), "{size}");
        if (wanted.1, wanted.2) == (None, None) {
            assert!(is(own.radius(), Some(before.radius())), "{size}");
        }
        assert_eq!(scene.looks[0].name, "base");
    }
    let folder = Folder::with("s.toml", &format!("{BLOCK}{LATE}"));
    folder.write("sweep.toml", "scene = \"s.toml\"\n[axes]\nalpha = [0.1, 0.2]\np = [1, 2, 3]\n");
    let sweep = rocking::Sweep::from_file(&folder.path("sweep.toml")).expect("valid");
    let last = sweep.scene(5).expect("valid").column;
    assert!((last.slenderness() - 0.2).abs() < 1e-12 && (last.stack(0).frequency_parameter() - 3.0).abs() < 1e-12);
    let told = folder.succeeds("check sweep.toml");
    assert_has(&told, &["size.alpha: 2 value(s)", "scenes of all points were read, and are valid"]);
}

#[test]
fn widths_heights_and_diameters_are_twice_the_halves() {
    let read = |text: &str| rocking::Scene::from_toml(text, "s.toml".as_ref()).map_err(Box::new);
    let halves =
        read("[column]\nblocks = 3\nshape = \"drum\"\nhalf_width = 0.4\ntop_half_width = 0.3\nhalf_height = 1.5\n")
            .expect("valid");
    let wholes = read("[column]\nblocks = 3\ndiameter = 0.8\ntop_diameter = 0.6\nheight = 3.0\n").expect("valid");
    assert_eq!(halves.column, wholes.column);
    let problem = |text: &str| read(text).expect_err("refused").to_string();
    assert!(
        problem("[column]\nblocks = 1\nwidth = 1\nhalf_width = 1\nheight = 2\n")
            .contains("`half_width` is given as well")
    );
    assert!(
        problem("[column]\nblocks = 1\nshape = \"prism\"\ndiameter = 1\nheight = 2\n").contains("a prism has a width")
    );
    assert!(problem("[column]\nblocks = 1\nwidth = -1\nheight = 2\n").contains("above zero"));
}
