//! Validity: friction demand and normal forces of a run without friction, up to the point of no return.

use crate::common::Folder;
use crate::common::scenes::{BLOCK, OVERTURNS};

#[test]
fn a_textbook_block_that_overturns_is_valid_up_to_the_point_of_no_return() {
    let folder = Folder::with("s.toml", &format!("{BLOCK}{OVERTURNS}"));
    assert_eq!(folder.says("run s.toml --report").1, "", "no warning");
    let own = folder.summary();
    assert_eq!((&own["outcome"], &own["status"]), (&"overturns".into(), &"overturned".into()));
    let (validity, fallen) = (&own["validity"], own["overturned_at"].as_f64().expect("a time"));
    let until = validity["until"].as_f64().expect("a time");
    assert!(until > 0.0 && until < fallen - 0.1, "{until} {fallen}");
    let contact = &validity["contacts"][0];
    let demand = contact["friction_demand"]["value"].as_f64().expect("finite");
    let whole = own["friction_demand"][0].as_f64().unwrap_or(f64::INFINITY);
    assert!(demand < 1.0 && whole > demand, "{demand} {whole}");
    let [t, theta] = ["t", "theta"].map(|key| contact["friction_demand"][key].as_f64().expect("a number"));
    let alpha = own["alpha"][0].as_f64().expect("a number");
    assert!(t <= until && theta.abs() <= alpha * 1.000001, "{t} {theta}");
    assert!(contact["min_normal_force"]["value"].as_f64().expect("finite") > 0.0);
    let page = folder.page();
    assert!(!page.contains("The model does not hold") && page.contains("point of no return"));
    // At the point of no return the block is balanced over its corner.
    let response = folder.table("out/response.csv");
    let beyond = response.rows().filter(|row| row.number("theta_1").abs() > alpha).map(|row| row.number("t"));
    let first = beyond.fold(f64::INFINITY, f64::min);
    assert!(until <= first && until > first - 0.0101, "{until} {first}");
}

/// What each contact needs, against rows every 0.1 ms: in swings of one block, of two as one, in steps of both methods, and at rest under a record.
#[test]
fn durations_of_friction_demand_are_those_of_the_rows() {
    let block = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[initial]\ntheta = [0.2]\n";
    let wide = "[[block]]\nhalf_width = 0.6\nhalf_height = 1.0\n[initial]\ntheta = [0.45]\n";
    let two = "[[block]]\nhalf_width = 0.4843122619043116\nhalf_height = 0.9728554377788956\n[[block]]\nhalf_width = 0.4391475102706481\n\
               half_height = 0.8915249772159544\n[initial]\ntheta = [0.05659501210508417, 0.05659501210508417]\n";
    let at_rest = "[[block]]\nhalf_width = 0.5\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"record\"\nunits = \"g\"\ndt = 0.1\n\
                   accel = [0.45, -0.45, 0.45, -0.45, 0.45, -0.45, 0.45, -0.45, 0.45, -0.45, 0.45, -0.45, 0.45, -0.45, 0.45, -0.45, 0.45]\n";
    // Beyond its balance, the block moves inwards, turns, and comes out past its start.
    let returning =
        "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.345]\nomega = [-0.1]\n";
    let mut reached = 0;
    for (column, method, t_end) in [
        (returning, "auto", 1.5),
        (block, "auto", 4.0),
        (wide, "auto", 1.5),
        (wide, "kutta-merson", 1.5),
        (two, "auto", 2.0),
        (two, "taylor", 2.0),
        (at_rest, "auto", 1.6),
    ] {
        let text = format!("{column}[solver]\nt_end = {t_end}\nmethod = \"{method}\"\n[output]\ndt = 1e-4\n");
        let scene = rocking::Scene::from_toml(&text, "s.toml".as_ref()).expect("valid");
        let response = rocking::simulate(&scene).expect("solved");
        for (interface, needs) in response.validity.as_ref().expect("forces are recorded").contacts.iter().enumerate() {
            let demands = response.samples.iter().map(|row| {
                let force = &row.contact_forces(&scene.column)[interface];
                (row.t, force.tangential.abs() / force.normal, row.theta[interface])
            });
            let demands: Vec<(f64, f64, f64)> = demands.collect();
            for above in &needs.above {
                let time = 1e-4 * demands.iter().filter(|(_, demand, _)| *demand > above.coefficient).count() as f64;
                // Demands are parabolas in the panels of a step, and rows are 0.1 ms apart.
                assert!((above.time - time).abs() <= 0.005 * time + 0.002, "{column}{method}: {above:?} {time}");
                assert!((above.share - above.time / t_end).abs() < 1e-12);
                reached += usize::from(above.time > 0.0);
            }
            let largest = demands.iter().fold((0.0, 0.0, 0.0), |most, own| if own.1 > most.1 { *own } else { most });
            let own = needs.friction_demand;
            assert!((own.value - largest.1).abs() < 1e-3 * largest.1, "{own:?} {largest:?}");
            if column != at_rest {
                assert!(
                    (own.t - largest.0).abs() < 2e-3 && (own.theta - largest.2).abs() < 2e-3,
                    "{own:?} {largest:?}"
                );
            }
        }
    }
    assert_eq!(reached, 6, "durations above zero");
}

#[test]
fn sweeps_carry_what_contacts_need() {
    let folder = Folder::with("s.toml", &format!("{BLOCK}{OVERTURNS}"));
    let sweep = "scene = \"s.toml\"\nask = \"validity\"\n[axes]\namplitude_uplift = [0.5, 2, 4]\n";
    folder.write("sweep.toml", sweep);
    folder.succeeds("sweep sweep.toml --out t.csv");
    let table = folder.table("t.csv");
    assert_eq!(table.texts("valid"), ["true"; 3], "{table:?}");
    let (demands, forces) = (table.numbers("mu_demand"), table.numbers("min_normal"));
    // At rest the column asks for a / g = 0.5 tan α, and all of its weight presses.
    assert!((demands[0] - 0.5 * 0.4 / 1.56).abs() < 1e-3 && forces[0] == 1.0, "{table:?}");
    assert!(demands[2] > demands[1] && forces[2] < 1.0, "{table:?}");
    assert_eq!(table.row(2).number("separations"), 0.0);
    // A block that rocks by itself: its impacts ask for 3t / (4 + t²), which is less than its swings do; at rest nothing strikes.
    let (slenderness, at_impacts) = (0.4f64 / 1.56, table.numbers("mu_demand_at_impacts"));
    let expected = 3.0 * slenderness / (4.0 + slenderness * slenderness);
    assert_eq!(at_impacts[0], 0.0);
    assert!((at_impacts[1] - expected).abs() < 1e-12, "{at_impacts:?}, {expected}");
}

/// Impacts may ask for more friction than the forces between them: the verdict of the report and its table say both.
#[test]
fn the_report_says_what_impacts_ask_for() {
    let scene = "[column]\nblocks = 2\nhalf_width = 0.225\nhalf_height = 1.618\n[excitation.horizontal]\nkind = \"sine-pulse\"\n\
                 amplitude_g = 0.4922828508385142\nfrequency = 2.060751486038808\n";
    let folder = Folder::with("s.toml", scene);
    folder.succeeds("run s.toml --out o --no-trust --report");
    let report = folder.read("o/report.html");
    let summary = folder.json("o/summary.json");
    let largest = |key: &str| {
        let contacts = summary["validity"]["contacts"].as_array().expect("a list");
        contacts.iter().map(|contact| contact[key]["value"].as_f64().expect("a number")).fold(0.0, f64::max)
    };
    let [forces, impacts] = ["friction_demand", "impulse_friction_demand"].map(largest);
    assert!(impacts > forces && forces > 0.0, "{forces} {impacts}");
    assert!(report.contains(&format!("impacts ask for up to {:.3}", impacts)), "{impacts}");
    assert!(report.contains("the same of impulses at impacts"));
    // A folder of an earlier version has the largest of the whole run alone.
    let mut earlier = summary.clone();
    for contact in earlier["validity"]["contacts"].as_array_mut().expect("a list") {
        contact.as_object_mut().expect("a table").remove("impulse_friction_demand");
    }
    folder.write("o/summary.json", earlier.to_string());
    folder.succeeds("report o");
    let of_run = summary["impulse_friction_demand"][0].as_f64().expect("a number");
    assert!(folder.read("o/report.html").contains(&format!("<td>{of_run:.3}</td>")), "{of_run}");
}

/// The page of a run without companions.
fn page_of(scene: &str) -> String {
    let folder = Folder::with("s.toml", scene);
    folder.succeeds("run s.toml --no-trust --report");
    folder.page()
}

#[test]
fn at_rest_each_contact_carries_all_of_the_weight_above_it() {
    let page = page_of("[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[solver]\nt_end = 1.0\n");
    assert_eq!(page.matches(" (100 % of the weight) <span").count(), 2);
}

/// The ground falls at 1.5 g for 0.3 s of 0.5 s.
#[test]
fn the_report_says_for_which_share_of_the_time_a_contact_would_pull() {
    let page = page_of(
        "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.vertical]\nkind = \"rectangular\"\namplitude_g = -1.5\n\
         duration = 0.3\n[solver]\nt_end = 0.5\n",
    );
    let row = page.lines().skip_while(|line| !line.contains("N &lt; 0")).find(|line| line.contains("scope=\"row\""));
    assert!(row.is_some_and(|row| row.ends_with("<td>0.3 <span class=\"note\">60 %</span></td></tr>")), "{row:?}");
}

/// A block leans on a flat one that falls back and stops: it turns on faster, and its centre falls at 0.48 m/s instead of 0.46 m/s.
#[test]
fn the_report_says_that_an_impact_would_have_to_pull() {
    let folder = Folder::with(
        "s.toml",
        "[[block]]\nhalf_width = 0.6\nhalf_height = 0.3\n[[block]]\nhalf_width = 0.3\nhalf_height = 0.3\n\
         [initial]\ntheta = [0.1, 0.1]\n[solver]\nt_end = 2.0\n",
    );
    folder.succeeds("run s.toml --no-trust --report");
    let upper = &folder.summary()["validity"]["contacts"][1];
    assert_eq!(upper["impulse_friction_demand"]["value"], "infinite");
    assert!(upper["min_normal_force"]["value"].as_f64().is_some_and(|force| force > 0.0), "{upper}");
    let told = "; at an impact interface 2 would have to pull: blocks may part there for an instant. The scene names no coefficient.";
    assert_eq!(folder.page().matches(told).count(), 2, "at the top and in the section");
}
