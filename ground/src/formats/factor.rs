//! Factors beside the unit of accelerations: `% of g`, `[g]*10`. With one the unit is another, which no reader knows.

/// Whether a factor stands beside a unit, in the text before or after it up to a comma: `% of g`, `10^-2 m/s2`, `Acc x10 (g)`, `100*Acc (g)`, `g / 10`,
/// `(g) * 9.81`. A name by itself (`X10`), a date and a scale (`1/10 scale`) are none.
pub fn has_factor(before: &str, after: &str) -> bool {
    let is_end = |c: char| ",;:=".contains(c);
    let before = before.rsplit(is_end).next().unwrap_or("").replace('_', " ");
    fn bare(word: &str) -> &str {
        word.trim_matches(['[', '(', ']', ')'])
    }
    let before: Vec<&str> = before.split_whitespace().map(bare).collect();
    let after: Vec<&str> = after.split(is_end).next().unwrap_or("").split_whitespace().map(bare).collect();
    let ends_in_factor = match before.as_slice() {
        [.., share, "of" | "Of" | "OF"] | [.., share] if is_share(share) => true,
        [.., sign, size] if is_sign(sign) => is_size(size, sign),
        [_, .., last] => is_signed(last) || is_decimal(last) || is_power(last),
        [only] => is_power(only),
        [] => false,
    };
    let begins_with_factor = match after.as_slice() {
        [sign, size, ..] if is_sign(sign) => is_size(size, sign),
        [first, ..] => is_signed(first),
        [] => false,
    };
    ends_in_factor || begins_with_factor || before.iter().any(|word| is_product(word))
}

/// Whether a word makes a unit a part of it: `%`, `35%`, `percent`, `tenth`.
fn is_share(word: &str) -> bool {
    let word = word.to_lowercase();
    let parts = ["percent", "permil", "tenth", "hundredth", "thousandth", "millionth"];
    word.ends_with('%') || parts.iter().any(|begin| word.starts_with(begin))
}

fn is_sign(word: &str) -> bool {
    ["*", "×", "/", "x", "X"].contains(&word)
}

/// Whether a word is the size of a factor behind its sign. A letter as sign needs a power of ten or a decimal number: `x 2` and `X1` are names.
fn is_size(word: &str, sign: &str) -> bool {
    let is_power_of_ten = word.len() > 1 && word.starts_with('1') && word[1..].bytes().all(|byte| byte == b'0');
    let is_number = word.starts_with(|c: char| c.is_ascii_digit() || c == '.') && word.parse::<f64>().is_ok();
    is_number && (is_power_of_ten || word.contains('.') || ["*", "×", "/"].contains(&sign))
}

/// Whether a word is a factor with its sign: `x100`, `*9.81`, `/10`, `1/100`.
fn is_signed(word: &str) -> bool {
    let word = word.strip_prefix('1').filter(|rest| rest.starts_with('/') && is_size(&rest[1..], "x")).unwrap_or(word);
    let end = word.char_indices().nth(1).map_or(word.len(), |(at, _)| at);
    let (sign, size) = word.split_at(end);
    is_sign(sign) && is_size(size, sign)
}

/// Whether a word is a product with a number: `100*Acc`, `Acc*10`, `0.01*`, but not `m/s**2`.
fn is_product(word: &str) -> bool {
    !word.contains("**")
        && word.contains(['*', '×'])
        && word.split(['*', '×']).any(|part| !part.is_empty() && part.parse::<f64>().is_ok())
}

/// Whether a word is a decimal number below one: `0.01 g`. Larger ones may be a place: `Floor 2.5 (g)`.
fn is_decimal(word: &str) -> bool {
    word.starts_with("0.") && word.parse::<f64>().is_ok()
}

/// Whether a word is a power of ten: `10^-2`, `10**3`.
fn is_power(word: &str) -> bool {
    word.starts_with("10^") || word.starts_with("10**")
}
