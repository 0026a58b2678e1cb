//! Numbers in record files: as Fortran and spreadsheets print them, between blanks, glued together, or in columns of fixed width.
//!
//! Rows are divided at blanks first. Where that fails or yields fewer samples than the header declares, they are divided by the width
//! of their columns, which an edit descriptor in the file or the format's description gives. The columns also show whether a file
//! that is cut off ends within a number: the remainder of that number may read as another number. Nothing here knows a file format.

use crate::error::RecordError;

/// Whether a character separates two numbers of a row.
pub fn separator(c: char) -> bool {
    c.is_whitespace() || c == ',' || c == ';'
}

/// A finite number: `12`, `-.64E-02`, `1.5D+01`, `5.`, and `0.1234-105`, Fortran's way of printing an exponent of three digits
/// in a field that has no place left for the `E`.
pub fn number(word: &str) -> Option<f64> {
    let plain = word.bytes().all(|b| b.is_ascii_digit() || b"+-.eEdD".contains(&b));
    if !plain {
        return None;
    }
    let value: f64 = match word.replace(['d', 'D'], "e").parse() {
        Ok(value) => value,
        Err(_) => {
            let (mantissa, exponent) = word.split_at_checked(word.len().checked_sub(EXPONENT)?)?;
            if !(is_exponent(exponent) && is_decimal(mantissa)) {
                return None;
            }
            format!("{mantissa}e{exponent}").parse().ok()?
        }
    };
    value.is_finite().then_some(value)
}

/// Length of an exponent without letter: a sign and three digits.
const EXPONENT: usize = 4;

fn is_exponent(text: &str) -> bool {
    text.len() == EXPONENT && text.starts_with(['+', '-']) && text[1..].bytes().all(|b| b.is_ascii_digit())
}

/// Digits with a decimal point, without exponent.
fn is_decimal(text: &str) -> bool {
    text.contains('.') && !text.contains(['e', 'E', 'd', 'D']) && text.parse::<f64>().is_ok()
}

/// A word of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word<'t> {
    /// Column of the first character, from 1.
    pub column: usize,
    /// Characters of the word.
    pub text: &'t str,
}

impl Word<'_> {
    /// Column of the last character, from 1.
    fn end(&self) -> usize {
        self.column - 1 + self.text.chars().count()
    }

    /// Number of characters after the last point; `None` without a point.
    fn after_point(&self) -> Option<usize> {
        self.text.rsplit_once('.').map(|(_, after)| after.chars().count())
    }
}

/// The words between separators.
pub fn words(row: &str) -> impl Iterator<Item = Word<'_>> {
    let (mut rest, mut column) = (row, 1);
    std::iter::from_fn(move || {
        let trimmed = rest.trim_start_matches(separator);
        column += rest[..rest.len() - trimmed.len()].chars().count();
        let text = trimmed.split(separator).next().filter(|text| !text.is_empty())?;
        let word = Word { column, text };
        column += text.chars().count();
        rest = &trimmed[text.len()..];
        Some(word)
    })
}

/// The numbers of a word: one, or several that touch because the sign took the blank's place (`-0.1E-02-0.2E-02`).
///
/// Glued numbers must have decimal points: a date (`2011-03-11`) is no row of numbers.
fn glued(text: &str, found: &mut Vec<f64>) -> Option<()> {
    if let Some(value) = number(text) {
        found.push(value);
        return Some(());
    }
    let bytes = text.as_bytes();
    let mut starts = vec![0];
    starts.extend((1..bytes.len()).filter(|at| b"+-".contains(&bytes[*at]) && !b"eEdD".contains(&bytes[at - 1])));
    starts.push(bytes.len());
    if !text.is_ascii() || starts.len() < 3 {
        return None;
    }
    let before = found.len();
    let mut index = 0;
    while index + 1 < starts.len() {
        let piece = &text[starts[index]..starts[index + 1]];
        let exponent = starts.get(index + 2).map_or("", |end| &text[starts[index + 1]..*end]);
        let (piece, taken) = if is_exponent(exponent) && is_decimal(piece) {
            (&text[starts[index]..starts[index + 2]], 2)
        } else {
            (piece, 1)
        };
        match number(piece).filter(|_| piece.contains('.')) {
            Some(value) => found.push(value),
            None => {
                found.truncate(before);
                return None;
            }
        }
        index += taken;
    }
    Some(())
}

/// The numbers of a row, split at separators and at signs.
///
/// # Errors
/// [`RecordError::NotANumber`], [`RecordError::DecimalComma`]
pub fn split(row: &str, line: usize) -> Result<Vec<f64>, RecordError> {
    if let Some(word) = decimal_comma(row) {
        return Err(comma_refused(line, word));
    }
    let mut found = Vec::new();
    for word in words(row) {
        glued(word.text, &mut found).ok_or_else(|| refused(line, word))?;
    }
    Ok(found)
}

/// The first number of a row whose numbers, several between blanks, all have one comma and no point: `9,98E-04  9,99E-04`. The commas of a list of
/// numbers stand beside points or without blanks.
fn decimal_comma(row: &str) -> Option<Word<'_>> {
    if !row.contains(',') || row.contains('.') {
        return None;
    }
    let mut words = row.split_whitespace();
    let first = words.next().filter(|word| has_decimal_comma(word))?;
    let others: Vec<&str> = words.collect();
    let column = row.find(first).map_or(1, |at| row[..at].chars().count() + 1);
    (!others.is_empty() && others.iter().all(|word| has_decimal_comma(word))).then_some(Word { column, text: first })
}

/// Whether a word is a number with a decimal comma: digits on both sides of its only comma.
pub fn has_decimal_comma(word: &str) -> bool {
    word.trim_start_matches(['+', '-']).split_once(',').is_some_and(|(whole, rest)| {
        !whole.is_empty()
            && whole.bytes().all(|b| b.is_ascii_digit())
            && rest.starts_with(|c: char| c.is_ascii_digit())
            && !rest.contains(',')
    })
}

/// The error that a word has a decimal comma.
pub fn comma_refused(line: usize, word: Word) -> RecordError {
    RecordError::DecimalComma { line, column: word.column, text: quote(word.text, LONGEST_QUOTE) }
}

/// The error that a word is no number.
pub fn refused(line: usize, word: Word) -> RecordError {
    RecordError::NotANumber { line, column: word.column, text: quote(word.text, LONGEST_QUOTE) }
}

/// The first characters of a text. Control characters are replaced: a terminal would obey them.
pub fn quote(text: &str, most: usize) -> String {
    text.chars().take(most).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// Largest number of characters of the file that an error quotes: a binary file has words of any length.
const LONGEST_QUOTE: usize = 40;

/// Whether a row is text: a heading, a remark, the line that ends a block. It has letters other than those of exponents, and no word of it is
/// a number.
pub fn is_text(row: &str) -> bool {
    // Words whose only letters are those of exponents may be numbers that touch.
    let has_letters = row.contains(|c: char| c.is_alphabetic() && !"eEdD".contains(c));
    let is_no_number = |word: Word| !is_undefined(word.text) && glued(word.text, &mut Vec::new()).is_none();
    has_letters && words(row).all(is_no_number)
}

/// Whether a word is a printed `nan`, `inf` or `****`. It is not text: it must be refused, not skipped.
pub fn is_undefined(word: &str) -> bool {
    let lower = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
    ["nan", "inf", "infinity"].contains(&lower.as_str()) || lower.starts_with('*')
}

/// Whether a line has no samples: it is blank or text.
pub fn is_remark(line: &str) -> bool {
    line.trim().is_empty() || is_text(line)
}

/// Columns of equal width, in characters. A Fortran edit descriptor such as `8F10.5` states the width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedWidth(pub usize);

impl FixedWidth {
    /// Columns of the first descriptor in brackets: `(8f10.6)`, `Format= (10I8)`, `(1P5E15.7)`, but not `(6(1X,F9.4))`. If there is
    /// none, columns of the first word without brackets that can be nothing but a descriptor: `8F10.3`.
    pub fn find(text: &str) -> Option<FixedWidth> {
        let in_brackets = text.split('(').skip(1).find_map(|rest| FixedWidth::parse(rest.split_once(')')?.0));
        let alone = |word: &str| word.starts_with(|c: char| c.is_ascii_digit()) && number(word).is_none();
        let bare =
            || text.split([' ', ',', '=']).filter(|word| alone(word) && word.contains('.')).find_map(FixedWidth::parse);
        in_brackets.or_else(bare)
    }

    fn parse(descriptor: &str) -> Option<FixedWidth> {
        let descriptor = descriptor.trim().to_ascii_uppercase();
        // A scale factor (`1P`) moves the decimal point, not the columns.
        let descriptor = match descriptor.split_once('P') {
            Some((factor, rest)) if factor.bytes().all(|b| b.is_ascii_digit() || b == b'-') => {
                rest.trim_start_matches(',').to_string()
            }
            _ => descriptor,
        };
        let letter = descriptor.find(['F', 'E', 'D', 'G', 'I'])?;
        let per_row: usize = match &descriptor[..letter] {
            "" => 1,
            repeat => repeat.trim().parse().ok()?,
        };
        // `ES15.7`, `EN15.7` and the like.
        let rest = descriptor[letter + 1..].trim_start_matches(['S', 'N']);
        let digits = rest.split(|c: char| !c.is_ascii_digit()).next()?;
        let width = digits.parse().ok()?;
        let sound = (1..=LARGEST_FIELD).contains(&width) && (1..=LARGEST_FIELD).contains(&per_row);
        sound.then_some(FixedWidth(width))
    }

    /// The numbers of a row, by columns.
    pub fn row(self, row: &str, line: usize) -> Result<Vec<f64>, RecordError> {
        let mut found = Vec::new();
        let mut rest = row.trim_end();
        let mut column = 1;
        while !rest.is_empty() {
            let end = rest.char_indices().nth(self.0).map_or(rest.len(), |(at, _)| at);
            let (field, after) = rest.split_at(end);
            let text = field.trim_matches(separator);
            let lead = field.chars().take_while(|c| separator(*c)).count();
            let value = number(text).ok_or_else(|| refused(line, Word { column: column + lead, text }))?;
            found.push(value);
            column += self.0;
            rest = after;
        }
        Ok(found)
    }
}

/// Largest width of a field, and largest number of fields in a row. More is a misread header.
const LARGEST_FIELD: usize = 200;

/// Samples of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Numbers as printed, in the unit of the file.
    pub values: Vec<f64>,
    /// Whether the last row ends within a number. That number is left out.
    pub cut: bool,
    /// Warnings, a sentence each.
    pub warnings: Vec<String>,
}

/// A block of samples that a header announces.
#[derive(Clone, Copy, Debug)]
pub struct Block<'t> {
    /// All lines of the file.
    pub lines: &'t [&'t str],
    /// First line of the block and the line after its last one, counted from 0.
    pub span: (usize, usize),
    /// Number of samples that the header declares; all are read where it declares none.
    pub declared: Option<usize>,
    /// Entry of the header that declares the number of samples: line, from 1, and name.
    pub header: (usize, &'static str),
    /// Columns of the rows, used if blanks do not separate the numbers.
    pub columns: Option<FixedWidth>,
    /// Whether missing samples are accepted.
    pub lenient: bool,
}

impl Block<'_> {
    /// Reads the block: at blanks, else by columns.
    ///
    /// # Errors
    /// [`RecordError::NotANumber`], [`RecordError::Fewer`], [`RecordError::More`]
    pub fn read(&self) -> Result<Samples, RecordError> {
        let enough = |found: &Samples| found.values.len() >= self.declared.unwrap_or(0);
        let at_blanks = self.rows(split);
        if at_blanks.as_ref().is_ok_and(enough) || matches!(at_blanks, Err(RecordError::More { .. })) {
            return at_blanks;
        }
        let by_columns = self.columns.map(|columns| self.rows(|row, line| columns.row(row, line)));
        let mut found = match (at_blanks, by_columns) {
            (_, Some(Ok(columns))) if enough(&columns) => return Ok(columns),
            (Ok(blanks), _) => blanks,
            (Err(_), Some(Ok(columns))) => columns,
            (Err(_), Some(Err(error @ RecordError::More { .. }))) => return Err(error),
            (Err(error), _) => return Err(error),
        };
        let (Some(declared), (line, key), count) = (self.declared, self.header, found.values.len()) else {
            return Ok(found);
        };
        if !self.lenient {
            return Err(RecordError::Fewer { line, key, declared, found: count });
        }
        let warning = format!("{count} samples where line {line} ({key}) declares {declared}; all of them are used");
        found.warnings.push(warning);
        Ok(found)
    }

    /// All rows. Samples beyond the declared number are dropped with a warning; twice the declared number or more is an error, as the rows then have
    /// columns that are not samples.
    fn rows(&self, read: impl Fn(&str, usize) -> Result<Vec<f64>, RecordError>) -> Result<Samples, RecordError> {
        let declared = self.declared.unwrap_or(usize::MAX);
        let mut values = Vec::new();
        let mut warnings = Vec::new();
        let end = self.span.1.min(self.lines.len());
        let cut = self.cut();
        for index in self.span.0..end {
            let line = self.lines[index];
            let row = cut.filter(|(place, _)| *place == index).map_or(line, |(_, whole)| whole);
            match read(row, index + 1) {
                Ok(row) => values.extend(row),
                Err(_) if values.len() >= declared => {
                    warnings.push(format!("text after the last sample is not read, from line {} on", index + 1));
                    break;
                }
                Err(_) if self.lenient && self.lines[index + 1..end].iter().all(|line| line.trim().is_empty()) => {
                    // A file that is cut off ends within a number.
                    values.extend(words(self.lines[index]).map_while(|word| number(word.text)));
                    warnings.push(format!("the last number, in line {}, is cut off and not used", index + 1));
                }
                Err(error) => return Err(error),
            }
        }
        if let Some((index, _)) = cut {
            warnings.push(format!("the last number, in line {}, is cut off and not used", index + 1));
        }
        if values.len() > declared {
            let ((line, key), count) = (self.header, values.len());
            if count / 2 >= declared {
                return Err(RecordError::More { line, key, declared, found: count });
            }
            warnings.push(format!(
                "{count} samples where line {line} ({key}) declares {declared}; the first {declared} are used"
            ));
            values.truncate(declared);
        }
        Ok(Samples { values, cut: cut.is_some(), warnings })
    }

    /// If the last row ends within a number: the line of that row, counted from 0, and the part of it with whole numbers. A row ends within a
    /// number if it ends at another place of the columns than all numbers of the rows above, which end with a column or one character before, and
    /// if the number has fewer characters after its point than each of those: numbers that stand at the left have no columns.
    fn cut(&self) -> Option<(usize, &str)> {
        let width = self.columns?.0;
        let after = self.span.1.min(self.lines.len());
        let mut rows = (self.span.0..after).rev().filter(|index| !self.lines[*index].trim().is_empty());
        let last = rows.next()?;
        let above: Vec<Word> = rows.take(ROWS_ABOVE).flat_map(|index| words(self.lines[index])).collect();
        let place = above.first()?.end() % width;
        let in_columns = [0, width - 1].contains(&place) && above.iter().all(|word| word.end() % width == place);
        let row = self.lines[last];
        let number = words(row).last()?;
        let is_number = number.text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        let is_shorter =
            above.iter().all(|word| word.after_point().is_none_or(|whole| number.after_point() < Some(whole)));
        if !in_columns || number.end() % width == place || !is_number || !is_shorter {
            return None;
        }
        let whole = number.end().checked_sub(place).map_or(0, |over| number.end() - over % width);
        let bytes = row.char_indices().nth(whole).map_or(row.len(), |(at, _)| at);
        Some((last, &row[..bytes]))
    }
}

/// Number of rows above the last one whose columns are compared with its own.
const ROWS_ABOVE: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_commas_are_refused_and_lists_with_commas_read() {
        let comma = RecordError::DecimalComma { line: 5, column: 2, text: "9,98E-04".into() };
        assert_eq!(split(" 9,98E-04  -9,99E-04", 5), Err(comma));
        assert_eq!(split("1,2", 1), Ok(vec![1.0, 2.0]));
        assert_eq!(split("1, 2, 3", 1), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(split("1.5,2 3,4.5", 1), Ok(vec![1.5, 2.0, 3.0, 4.5]));
    }

    #[test]
    fn numbers_are_read_as_fortran_prints_them() {
        for (text, value) in [
            ("12", 12.0),
            ("-.64E-02", -0.0064),
            ("1.5D+01", 15.0),
            ("2.5d-3", 0.0025),
            ("5.", 5.0),
            ("+.5", 0.5),
            ("0.1234-105", 0.1234e-105),
            ("-.1234+002", -12.34),
        ] {
            assert_eq!(number(text), Some(value), "{text}");
        }
        for text in
            ["", ".", "-", "nan", "inf", "1e999", "0x10", "--1", "1.2.3", "12-105", "1.5-10", "1.5E2-105", "é-105"]
        {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn glued_columns_part_at_their_signs() {
        assert_eq!(split("-0.1E-02-0.2E-02", 1), Ok(vec![-0.001, -0.002]));
        assert_eq!(split(" 0.5-0.25  1.-2.", 1), Ok(vec![0.5, -0.25, 1.0, -2.0]));
        assert_eq!(split("0.1234-105-0.5678-106 -.5+100", 1), Ok(vec![0.1234e-105, -0.5678e-106, -0.5e100]));
        assert_eq!(split("0.1234-0.105", 1), Ok(vec![0.1234, -0.105]));
        let error = |text: &str| RecordError::NotANumber { line: 3, column: 3, text: text.into() };
        for text in ["2011-03-11", "1.5-", "0.5-x", "0.5--0.5"] {
            assert_eq!(split(&format!("1 {text}"), 3), Err(error(text)), "{text}");
        }
    }

    #[test]
    fn columns_count_characters_not_bytes() {
        assert_eq!(split("é 1", 2), Err(RecordError::NotANumber { line: 2, column: 1, text: "é".into() }));
        let found: Vec<Word> = words("é; b").collect();
        assert_eq!(found, [Word { column: 1, text: "é" }, Word { column: 4, text: "b" }]);
    }

    #[test]
    fn numbers_that_stand_at_the_left_have_no_columns() {
        let whole = ["1.00000000e-03", "2.00000000e-03", "3.00000000e-03", "1.00000000e-03", "-1.00000000e-03"];
        let read = |lines: &[&str], declared: usize| {
            let columns = Some(FixedWidth(15));
            let span = (0, lines.len());
            Block { lines, span, declared: Some(declared), header: (1, "NPTS"), columns, lenient: false }.read()
        };
        let samples = read(&whole, 5).expect("all numbers are there");
        assert_eq!((samples.values[4], samples.cut), (-0.001, false));
        // The other way round: 14 characters below rows of 15.
        let negative: Vec<String> = whole.iter().map(|row| format!("-{}", row.trim_start_matches('-'))).collect();
        let mut lines: Vec<&str> = negative.iter().map(String::as_str).collect();
        lines.push("1.00000000e-03");
        assert_eq!(read(&lines, 6).expect("all numbers are there").values[5], 0.001);
        // A number that is cut off is shorter behind its point.
        for cut in ["-1.00000000e-0", "-1.00000000e", "-1.0"] {
            lines[5] = cut;
            let found = read(&lines, 6);
            assert!(matches!(found, Err(RecordError::Fewer { declared: 6, found: 5, .. })), "{cut}: {found:?}");
        }
    }

    #[test]
    fn descriptors_give_the_width() {
        for (text, width) in [
            ("in cm/sec2. (8f10.6)", 10),
            ("units=cm/sec2 (04), Format=(5E15.7)", 15),
            ("Format= (10I8)", 8),
            ("(1P5E15.7)", 15),
            ("(1F15.6E)", 15),
            ("(F12.4)", 12),
            ("(6ES14.5)", 14),
            ("at 0.005 sec, in cm/sec2. 8F10.3", 10),
        ] {
            assert_eq!(FixedWidth::find(text), Some(FixedWidth(width)), "{text}");
        }
        for text in ["", "(04)", "(cm)", "(8f)", "(0F10.5)", "(9F999.5)", "2 F10", "1.5E10", "(99999999999999999999F3)"]
        {
            assert_eq!(FixedWidth::find(text), None, "{text}");
        }
    }

    #[test]
    fn columns_of_fixed_width_need_no_blanks() {
        let columns = FixedWidth(5);
        assert_eq!(columns.row("12.3445.67 -8.9", 1), Ok(vec![12.34, 45.67, -8.9]));
        assert_eq!(columns.row("  1.0  2.0   ", 1), Ok(vec![1.0, 2.0]));
        assert_eq!(
            columns.row("  1.0  2,x", 4),
            Err(RecordError::NotANumber { line: 4, column: 8, text: "2,x".into() })
        );
    }

    #[test]
    fn a_block_is_read_by_columns_where_blanks_do_not_part_it() {
        let lines = ["head", "12.3445.67 -8.9", "  1.0"];
        let columns = Some(FixedWidth(5));
        let block =
            Block { lines: &lines, span: (1, 3), declared: Some(4), header: (1, "NPTS"), columns, lenient: false };
        assert_eq!(block.read().expect("four").values, [12.34, 45.67, -8.9, 1.0]);
        let longer = Block { declared: Some(9), ..block };
        assert_eq!(longer.read(), Err(RecordError::Fewer { line: 1, key: "NPTS", declared: 9, found: 4 }));
        let lenient = Block { lenient: true, ..longer }.read().expect("four");
        assert!(lenient.values.len() == 4 && lenient.warnings[0].contains("declares 9"), "{lenient:?}");
        let all = Block { declared: None, ..block }.read().expect("four");
        assert_eq!(all.values.len(), 4);
        let half = Block { declared: Some(2), ..block }.read();
        assert_eq!(half, Err(RecordError::More { line: 1, key: "NPTS", declared: 2, found: 4 }));
        let shorter = Block { declared: Some(3), ..block }.read().expect("three");
        assert_eq!(shorter.values, [12.34, 45.67, -8.9]);
        assert!(shorter.warnings[0].contains("4 samples"), "{shorter:?}");
    }

    #[test]
    fn what_is_left_of_a_number_is_none() {
        let columns = Some(FixedWidth(10));
        let block = |lines: &[&str]| {
            let block = Block {
                lines,
                span: (0, lines.len()),
                declared: Some(4),
                header: (1, "NPTS"),
                columns,
                lenient: false,
            };
            block.read()
        };
        let fewer = |found| Err(RecordError::Fewer { line: 1, key: "NPTS", declared: 4, found });
        // .5E-03 without its exponent would be a thousand times itself.
        assert_eq!(block(&["    .2E-02   -.1E-02", "    .3E-02    .5"]), fewer(3));
        assert_eq!(block(&["    .2E-02   -.1E-02", "    .3E-02    .5E"]), fewer(3));
        assert_eq!(block(&["    .2E-02   -.1E-02", "    .3"]), fewer(2));
        assert_eq!(block(&["   .2E-02   -.1E-02 ", "   .3E-02    .5"]), fewer(3));
        // Numbers that stand in no columns may have any length.
        for rows in [["    .2E-02   -.1E-02", "    .3E-02    .5E-03"], [".2E-02 -.1E-02", ".3 .5"], ["1 2", "3 4"]] {
            assert_eq!(block(&rows).expect("four").values.len(), 4, "{rows:?}");
        }
    }
}
