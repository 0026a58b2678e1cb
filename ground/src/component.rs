//! Components of a record, recognised by the file names that the databases give.

use serde::Serialize;
use std::borrow::Cow;

/// Direction of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// Along the ground.
    Horizontal,
    /// Upwards.
    Vertical,
}

impl Direction {
    /// The direction of a component. It is vertical if `ending`, from the file's name ([`record_and_component`]), or `component`, as the file
    /// itself states it, names a vertical one.
    pub fn of(ending: &str, component: &str) -> Direction {
        let is_vertical = |name: &str| {
            let name = name.trim().to_ascii_uppercase();
            let first = name.split([' ', '(']).next().unwrap_or("");
            // A location code may follow: `BHZ00`.
            let (code, location) = first.split_at_checked(CODE).unwrap_or((first, ""));
            let is_location = location.bytes().all(|b| b.is_ascii_digit());
            let is_code = is_channel_code(code) && code.ends_with(['Z', '3']) && is_location;
            is_code || VERTICAL.contains(&first.trim_end_matches(['1', '2'])) || has_vertical_word(&name)
        };
        if is_vertical(ending) || is_vertical(component) { Direction::Vertical } else { Direction::Horizontal }
    }
}

/// Whether a word of a name in capitals says that a component is vertical, and none says that it is horizontal: `ACC UD`, `U-D`, `UP-DOWN`, `CH3-UD`,
/// `ACC_Z`, `ACCZ`, `VERTICAL`.
fn has_vertical_word(name: &str) -> bool {
    let whole = [("U-D", "UD"), ("D-U", "UD"), ("N-S", "NS"), ("E-W", "EW")];
    let name = whole.iter().fold(name.to_string(), |name, (parted, whole)| name.replace(parted, whole));
    let words = || name.split(|c: char| !c.is_alphanumeric());
    let is_vertical = |word: &str| {
        let after = ["ACCELERATION", "ACCEL", "ACC"].iter().find_map(|start| word.strip_prefix(start));
        WORDS_FOR_VERTICAL.contains(&after.unwrap_or(word)) || word.starts_with("VERT")
    };
    WHOLE_FOR_VERTICAL.contains(&name.as_str())
        || words().any(is_vertical)
            && !words().any(|word| ["NS", "EW", "H", "H1", "H2"].contains(&word) || word.starts_with("HOR"))
}

/// Whether a whole name is that of a component, as above the columns of a table: `NS`, `E-W`, `U-D`, `N00E`, `X`, `CANAL-1`, `090`.
pub(crate) fn is_component(name: &str) -> bool {
    let upper: String = name.to_uppercase().chars().filter(|c| c.is_alphanumeric()).collect();
    let own = ["ACCELERATION", "ACCEL", "ACC"].iter().find_map(|start| upper.strip_prefix(start)).unwrap_or(&upper);
    let own = own.strip_prefix('A').filter(|axis| ["X", "Y", "Z"].contains(axis)).unwrap_or(own);
    let is_word =
        ["NORTH", "EAST", "SOUTH", "WEST", "VERT", "LONG", "TRAN", "RADIAL"].iter().any(|begin| own.starts_with(begin));
    let (letters, digits) = own.split_at(own.find(|c: char| c.is_ascii_digit()).unwrap_or(own.len()));
    let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    let is_azimuth = letters.is_empty() && digits.len() == CODE
        || ["N", "S"].contains(&letters) && digits.len() > 1 && digits.ends_with(['E', 'W']);
    HORIZONTAL.contains(&own)
        || VERTICAL.contains(&own)
        || WHOLE_FOR_VERTICAL.contains(&own)
        || is_channel_code(own)
        || is_azimuth
        || is_word
        || is_number && ["CH", "CHAN", "CHANNEL", "CANAL", "COMP", "H"].contains(&letters)
}

/// Whether the ending of a file's name, or the component that the file states, says that positive values point down.
pub(crate) fn points_down(ending: &str, component: &str) -> bool {
    let is_down = |name: &str| {
        let first = name.trim().split([' ', '(']).next().unwrap_or("").to_ascii_uppercase();
        DOWN.contains(&first.as_str())
    };
    is_down(ending) || is_down(component)
}

/// Names of a component downwards.
const DOWN: [&str; 3] = ["DWN", "DOWN", "DN"];
/// Endings of file names that name a vertical component.
const VERTICAL: [&str; 13] = ["UP", "DWN", "DOWN", "VERTICAL", "VERT", "VER", "VRT", "VT", "UD", "DN", "U", "V", "Z"];
/// Words that name a vertical component wherever they stand in the name of a column.
const WORDS_FOR_VERTICAL: [&str; 7] = ["UP", "DWN", "DOWN", "VRT", "UD", "V", "Z"];
/// Whole names of a vertical component that have other meanings within longer names.
const WHOLE_FOR_VERTICAL: [&str; 2] = ["AZ", "DU"];
/// Endings of file names that name a horizontal component.
const HORIZONTAL: [&str; 11] = ["NS", "EW", "WE", "N", "E", "H1", "H2", "L", "T", "X", "Y"];

/// Sort key of a name by the first number in it: RSN77 comes before RSN125.
pub fn by_number(name: &str) -> (String, u64, String) {
    let start = name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len());
    let (text, rest) = name.split_at(start);
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    (text.into(), rest[..end].parse().unwrap_or(u64::MAX), rest.into())
}

/// Splits a file name into the part that the components of a record have in common and the part that names the component.
///
/// `RSN125_FRIULI.A_A-TMZ-UP.AT2`: RSN125, UP; `XXX0010103040506.EW`: EW; `XX.MIB..HNE.D.ASC`: HNE; `ELC180.AT2`: ELC, 180.
pub fn record_and_component(file: &str) -> (Cow<'_, str>, &str) {
    let (stem, extension) = file.rsplit_once('.').unwrap_or((file, ""));
    // K-NET, and KiK-net with its two depths.
    let upper = extension.to_ascii_uppercase();
    if ["EW", "NS", "UD"].contains(&upper.trim_end_matches(['1', '2'])) && upper.len() <= 3 {
        let depth = &extension[2..];
        return (if depth.is_empty() { stem.into() } else { format!("{stem} {depth}").into() }, extension);
    }
    // ITACA: `.._NCR__WEC`, direction and a letter for the processing; each processing is a record of its own.
    if let Some((record, ending)) = stem.rsplit_once("__")
        && let Some((direction, processing)) = ending.split_at_checked(2)
        && ["WE", "NS", "UP"].contains(&direction.to_ascii_uppercase().as_str())
        && matches!(processing.as_bytes(), [letter] if letter.is_ascii_alphabetic())
    {
        return (format!("{record} {processing}").into(), direction);
    }
    let (common, component) = component_of_stem(stem);
    // Network, station and channel code parted by points.
    let parts: Vec<&str> = stem.split('.').collect();
    let code = parts.iter().position(|part| is_channel_code(part)).filter(|_| parts.len() > 2);
    let digits = stem.get(3..).map_or(0, |rest| rest.bytes().take_while(u8::is_ascii_digit).count());
    if digits > 0 && stem[..3].eq_ignore_ascii_case("RSN") {
        return (stem[..3 + digits].to_ascii_uppercase().into(), code.map_or(component, |place| parts[place]));
    }
    match code {
        Some(place) => {
            let rest: Vec<&str> =
                parts.iter().enumerate().filter(|(index, _)| *index != place).map(|(_, part)| *part).collect();
            (rest.join(".").into(), parts[place])
        }
        None => (common.into(), component),
    }
}

/// Length of a channel code.
const CODE: usize = 3;

/// `HNE`, `HGZ`, `BHZ`: band, instrument (N, L, G for accelerometers, H for seismometers), direction.
fn is_channel_code(part: &str) -> bool {
    matches!(
        part.as_bytes(),
        [
            b'H' | b'B' | b'E' | b'C' | b'S',
            b'N' | b'L' | b'G' | b'H',
            b'E' | b'N' | b'Z' | b'1' | b'2' | b'3' | b'X' | b'Y'
        ]
    )
}

/// Splits a stem into the part before the name of the component and that name, which is empty if the stem has none.
fn component_of_stem(stem: &str) -> (&str, &str) {
    let upper = stem.to_ascii_uppercase();
    let parted = |start: usize| stem[..start].ends_with(['-', '_', ' ', '.']);
    let common = |start: usize| stem[..start].trim_end_matches(['-', '_', ' ', '.']);
    let last =
        upper.rsplit(['-', '_', ' ', '.']).next().filter(|last| last.len() < stem.len() && is_channel_code(last));
    if let Some(code) = last {
        let start = stem.len() - code.len();
        return (common(start), &stem[start..]);
    }
    // PEER gives endings to all its files. They need no separator there: `RSN77_SFERN_PULDWN`.
    let of_peer = upper.strip_prefix("RSN").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    let named = VERTICAL.into_iter().chain(HORIZONTAL).find_map(|ending| {
        let start = upper.strip_suffix(ending)?.len();
        // In other names an ending without a separator or a digit before it may be part of a word: RIVER, Group.
        let is_long = ending.len() > 2 || ending == "UP";
        let sure = parted(start)
            || (of_peer && is_long)
            || ["DWN", "VRT"].contains(&ending)
            || upper[..start].ends_with(|c: char| c.is_ascii_digit());
        (sure && start > 0 && stem.is_char_boundary(start)).then(|| (common(start), &stem[start..]))
    });
    named.unwrap_or_else(|| {
        // Three digits are an azimuth; fewer are the number of a record: GM_1.
        let digits = stem.bytes().rev().take_while(u8::is_ascii_digit).count();
        let start = stem.len() - digits;
        if digits == 3 && start > 0 { (common(start), &stem[start..]) } else { (stem, "") }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_record_and_component() {
        for (file, record, component, vertical) in [
            ("RSN125_FRIULI.A_A-TMZ000.AT2", "RSN125", "000", false),
            ("RSN125_FRIULI.A_A-TMZ-UP.AT2", "RSN125", "UP", true),
            ("RSN77_SFERN_PULDWN.AT2", "RSN77", "DWN", true),
            ("RSN9_X-VER.AT2", "RSN9", "VER", true),
            ("RSN8500_VIRGINIA_HNZ.AT2", "RSN8500", "HNZ", true),
            ("rsn8500_virginia_hne.at2", "RSN8500", "hne", false),
            ("RSN10590_ComalTX11-10-20_IU.CCM.BHZ.00.AT2", "RSN10590", "BHZ", true),
            ("RSN10590_ComalTX11-10-20_IU.CCM.BH1.00.AT2", "RSN10590", "BH1", false),
            ("quake_HHZ.csv", "quake", "HHZ", true),
            ("quake_X.txt", "quake", "X", false),
            ("quake_Z.txt", "quake", "Z", true),
            ("ELC180.AT2", "ELC", "180", false),
            ("ELC-UP.AT2", "ELC", "UP", true),
            ("I-ELC-V.AT2", "I-ELC", "V", true),
            ("mill_270.txt", "mill", "270", false),
            ("XXX0010103040506.EW", "XXX0010103040506", "EW", false),
            ("XXX0010103040506.UD", "XXX0010103040506", "UD", true),
            ("XXXH020103040506.UD2", "XXXH020103040506 2", "UD2", true),
            ("XX.MIB..HNZ.D.64.ASC", "XX.MIB..D.64", "HNZ", true),
            ("XX.MIB..HNE.D.64.ASC", "XX.MIB..D.64", "HNE", false),
            ("20010304_050607ITDPC_MIB__UPC.DAT", "20010304_050607ITDPC_MIB C", "UP", true),
            ("20010304_050607ITDPC_MIB__WEX.DAT", "20010304_050607ITDPC_MIB X", "WE", false),
            ("motion.csv", "motion", "", false),
            ("RIVER.csv", "RIVER", "", false),
            ("Group.csv", "Group", "", false),
            ("DENVER_UP.csv", "DENVER", "UP", true),
            ("C12DWN.AT2", "C12", "DWN", true),
            ("20101114_2309_RawAcc_U.asc", "20101114_2309_RawAcc", "U", true),
            ("GM_1.csv", "GM_1", "", false),
            ("Elcentro_vertical.txt", "Elcentro", "vertical", true),
            ("ABCVRT.AT2", "ABC", "VRT", true),
            ("GM_1V.csv", "GM_1", "V", true),
            ("GM_2.csv", "GM_2", "", false),
        ] {
            let (found, ending) = record_and_component(file);
            assert_eq!((&*found, ending), (record, component), "{file}");
            assert_eq!(Direction::of(ending, "") == Direction::Vertical, vertical, "{file}");
        }
        let mut names = ["RSN1004", "X", "RSN77", "RSN125"];
        names.sort_by_key(|name| by_number(name));
        assert_eq!(names, ["RSN77", "RSN125", "RSN1004", "X"]);
        assert_eq!(Direction::of("", "Up"), Direction::Vertical);
        assert_eq!(Direction::of("", "U-D surface (6)"), Direction::Vertical);
        assert_eq!(Direction::of("", "BHZ00"), Direction::Vertical);
        for name in [
            "Acc UD",
            "acc_UD",
            "AccZ",
            "Az",
            "a_z",
            "Z-axis",
            "Acc_V",
            "UP-DOWN",
            "DU",
            "CH3-UD",
            "Acc. vertical",
            "accel_vertical",
        ] {
            assert_eq!(Direction::of("", name), Direction::Vertical, "{name}");
        }
        for name in [
            "90 Deg",
            "N00E",
            "E-W",
            "Acc NS",
            "ax",
            "Chan 1: 360",
            "Santa Ana",
            "accx",
            "Accélération du sol",
            "Acc Az. NS",
            "Acc ver. B",
            "Acc H1/V",
            "Acc EW at U-D array",
        ] {
            assert_eq!(Direction::of("", name), Direction::Horizontal, "{name}");
        }
        for name in [
            "NS", "N-S", "E-W", "U-D", "V", "x", "N00E", "S45W", "CANAL-1", "Ch 2", "090", "HNZ", "acc_ns", "H1", "ax",
            "Accel NS", "North", "Vertical", "Tran",
        ] {
            assert!(is_component(name), "{name}");
        }
        for name in ["El", "Centro", "Acceleration", "values", "g", "1940", "PGA"] {
            assert!(!is_component(name), "{name}");
        }
        assert_eq!(Direction::of("", "90 Deg"), Direction::Horizontal);
        assert_eq!(Direction::of("", "BH100"), Direction::Horizontal);
        assert!(points_down("DWN", "") && points_down("", "Down (3)") && !points_down("UP", "U-D"));
    }
}
