//! Meanings of the names of emitted constants and statements.

/// Notation of the emitted modules, for their heads.
pub const NOTATION: &str = "
Blocks are counted from the base. In comments, p_i, h_i, m_i and I_i are the pivot offset, half-height, mass and centroidal moment of inertia of BLOCK i, and g is gravity; the code writes i_i for I_i. The pivot offset is positive at the right corner, negative at the left corner, zero at a closed interface.

Functions whose names end in `links_n` serve n links that are any rigid bodies: of tapered and displaced blocks, or several blocks that move as one. There p_i, m_i and I_i are those of BODY i, (e_xi, e_i) is its centroid and (t_xi, t_i) the centre of the contact above it, to the right and upwards from the centre of the contact below, in the axes of the body.

Links are the rigid runs of blocks between open interfaces, counted from the lowest that moves. The number in a NAME is that of a LINK: `omega_2` is the rate of link 2. A name with two numbers belongs to a pair of links; names of blocks and bodies say so, as in `pivot_of_block_2_times_mass_of_block_3`. Link 0 is the ground.

Angles are absolute and clockwise positive. `axial` is the component along the axis of a link, upwards; `lateral` is the component across the axis, to the left. A body vector (lateral, axial) of link a has the derivative (x, y) = (cos_a * axial + sin_a * lateral, cos_a * lateral - sin_a * axial) by the angle of the link: names with x and y are such derivatives. The stack of an interface is the blocks above it; a contact is the centre of a closed interface.

`link_inertia_a` is J_a, the moment of inertia about the pivot of link a of the link and all masses above, those concentrated in the next pivot. `link_moment_axial_a`, `link_moment_lateral_a` are S_a, their first moment about the pivot. `link_lever_axial_a`, `link_lever_lateral_a` are d_a, the vector from the pivot of link a to that of link a + 1. Names that begin with `link_` are in SI units.
";

/// Notation of step programs.
pub const PROGRAM_UNITS: &str = "
A step program solves the equations of motion, M theta_ddot = load, where load has gravity, ground motion and squared rates.

Accelerations do not depend on the unit of mass. Step programs measure mass by J_1, the moment of inertia of the lowest link: `inertia_ratio_a` is J_a / J_1, `moment_axial_a` is the axial component of S_a / J_1, and J_1 itself is one. Where an `inverse_gravity` is among the constants, linear accelerations are measured by gravity, so that gravity is one, too: moments are then times gravity, and levers over gravity.
";

/// Notation of programs with translations.
pub const TRANSLATIONS: &str = "
Links are the runs of blocks with one angle, counted from the lowest that turns; link 0 is the ground. Coordinates are the angles of the links, base first, then translations: the slides of interfaces, and two for each interface in flight, horizontal and vertical. Angles are absolute and clockwise positive.

Translation c moves what lies above its interface along (x, y) = (cos_face_c, -sin_face_c), a direction that turns at the rate face_omega_c. `carried_mass_c` is the mass that it moves. `carried_c_axial_a`, `carried_c_lateral_a` are the first moment of that mass about the pivot of link a, as far as link a turns it, the masses of higher links concentrated in the next pivot. In flight, the pivot of a link is the middle of its base, and the next pivot the middle of its top.

`link_inertia_a`, `link_moment_axial_a`, `link_moment_lateral_a` are the moment of inertia and first moment, about the pivot of link a, of the link and all masses above, those concentrated in the next pivot; `link_lever_axial_a`, `link_lever_lateral_a` lead from the pivot of link a to the next one. `axial` is the component along the axis of a link, upwards; `lateral` is the component across the axis, to the left. A body vector of link a has the derivative (x, y) = (cos_a * axial + sin_a * lateral, cos_a * lateral - sin_a * axial) by the angle of the link. All of these belong to the present slides. All units are SI.

The row of a slide is d'Alembert's principle tested along (1, lift_c) in the axes of its face, `lift_c` the coefficient of friction with the sign of the slide: T + lift_c N = 0. No normal force is solved for, and the matrix is not symmetric. In flight, `lift_c` is zero; for its vertical direction cos_face_c is 0 and sin_face_c is -1.

Which blocks a translation moves, and with which link its face turns, is in the values alone: one program serves all columns with as many angles and translations.
";

/// Comment before the first statement of a group; `None` within a group.
pub fn group(name: &str, previous: Option<&str>) -> Option<&'static str> {
    let of = |name: &str| {
        let stem = stem(name).0.trim_end_matches("_x").trim_end_matches("_y");
        Some(match stem {
            "ground_over_gravity" => "Ground acceleration in units of gravity.",
            "lever" | "moment" => {
                "Derivatives of the turned levers (d') and first moments (S') by the angles of their links, in the axes of the ground."
            }
            "test" => "Directions of the tests: along the face, lifted by the coefficient of friction.",
            "coupling" => {
                "Matrix entries of angle a and translation c: coupling_a_c is P_ca', the derivative of a first moment by the angle, along the translation."
            }
            "tested_coupling" | "tested_mass" => {
                "Rows of the translations: tested_coupling_c_a by angle a, tested_mass_c_d by translation d."
            }
            "coriolis" => "Coriolis accelerations of the translations along faces that turn.",
            "tested_load" => "Loads of the translations: minus the forces, tested.",
            stem if stem.starts_with("carried") => {
                "First moments P' of what the translations carry, in the axes of the ground: carried_c_x_a is a derivative by angle a."
            }
            "mass" => "Mass matrix off the diagonal: M_ba = d_a' . S_b' for links a < b.",
            "bias" => {
                "Coefficients of squared rates on the side of M: bias_b_a of rate a in equation b, -bias_b_a of rate b in equation a; loads have the opposite signs."
            }
            "omega_squared" => "Squared rates.",
            "pivot" => {
                "Accelerations of the pivots at constant rates, ground motion and gravity included, from the base up."
            }
            "pull" => "Centripetal forces of the links above, from the top down.",
            "load" => "Loads of the angles: gravity, ground motion and squared rates.",
            "reduced" | "scaled" | "factor" | "diagonal" | "inverse" | "determinant" => {
                "Elimination M = L D L^T with D_1 = 1: diagonal and inverse are D and 1 / D, scaled is L D below the blocks of D, factor is L, reduced is L^-1 load. The last two of three or more links are one 2x2 block of D, with its entry off the diagonal (scaled), its determinant, and its inverse."
            }
            "force" => "Force on the stack, the sum of mass times (acceleration + gravity), in the axes of the ground.",
            "theta_ddot" | "rest" => {
                "Back substitution: rest_a_b is the solution for link a without the terms of links below b."
            }
            _ => return None,
        })
    };
    let own = of(name)?;
    (previous.and_then(of) != Some(own)).then_some(own)
}

/// Meaning of a constant. In some programs gravity is the unit of acceleration: `is_by_gravity`.
pub fn meaning(name: &str, is_by_gravity: bool) -> String {
    let (stem, numbers) = stem(name);
    let link = numbers.first().copied().unwrap_or_default();
    if let Some(opposite) = name.strip_prefix("minus_") {
        return format!("minus the {}", meaning(opposite, is_by_gravity));
    }
    let (is_si, stem) = stem.strip_prefix("link_").map_or((false, stem), |stem| (true, stem));
    let by_inertia = if is_si { "" } else { " over J_1" };
    let [times_gravity, over_gravity] =
        if is_by_gravity && !is_si { [", times gravity,", ", over gravity"] } else { [""; 2] };
    let side = if stem.ends_with("axial") { "axial" } else { "lateral" };
    match stem {
        "inertia" | "inertia_ratio" => format!("moment of inertia J_{link}{by_inertia}"),
        "moment_axial" | "moment_lateral" => {
            format!("{side} component of the first moment S_{link}{times_gravity}{by_inertia}")
        }
        "lever_axial" | "lever_lateral" => format!("{side} component of the lever d_{link}{over_gravity}"),
        "weight_axial" | "weight_lateral" => format!("{side} component of the first moment S_{link}, times gravity, over J_1"),
        "steady_gravity" => "gravity, fixed by the scene".into(),
        "inverse_gravity" => "reciprocal of gravity".into(),
        "ground_moment" => "potential energy over gravity without the terms of the angles: masses times heights, those of moving links at the height of the lowest pivot".into(),
        "coupling_dot" => format!("scalar product of d_{link} and S_{}", numbers.last().copied().unwrap_or_default()),
        "coupling_cross" => {
            let other = numbers.last().copied().unwrap_or_default();
            format!("clockwise cross product of d_{link} and S_{other}: lateral d times axial S, minus axial d times lateral S")
        }
        "stack_mass" => "mass of the stack above the interface".into(),
        "stack_axial" | "stack_lateral" => {
            format!("{side} first moment about the pivot of link {link} of what the link turns of the stack, masses of higher links in the next pivot")
        }
        "contact_lever_axial" | "contact_lever_lateral" => format!("{side} lever from the contact to the next pivot"),
        "contact_moment_axial" | "contact_moment_lateral" => {
            format!("{side} first moment of the stack about the contact, masses of higher links in the next pivot")
        }
        "contact_moment_times_lever_axial" | "contact_moment_times_lever_lateral" => {
            format!("contact_moment_axial times the {side} component of d_{link}")
        }
        "contact_inertia" => "moment about the contact per angular acceleration of its link".into(),
        "contact_cross" | "contact_dot" if numbers.is_empty() => {
            "moment about the contact per squared rate of its link".into()
        }
        "contact_cross" => format!("clockwise cross product of the lever from the contact to the next pivot and S_{link}"),
        "contact_dot" => format!("scalar product of the lever from the contact to the next pivot and S_{link}"),
        _ => "coefficient of the factors in its name".into(),
    }
}

/// Splits a name into its stem and the numbers at its end.
fn stem(name: &str) -> (&str, Vec<&str>) {
    let mut numbers = Vec::new();
    let mut rest = name;
    while let Some((stem, number)) = rest.rsplit_once('_')
        && number.chars().all(|digit| digit.is_ascii_digit())
    {
        numbers.insert(0, number);
        rest = stem;
    }
    (rest, numbers)
}
