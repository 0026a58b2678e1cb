//! Hostile record files: whatever the bytes, reading ends in a record or an error, without a panic, soon, and with memory in proportion to
//! the file. A failure prints the seed that repeats it.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;
use rocking_ground::{AccelerationUnit, Motion, RecordFile, TextOptions};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;
use std::time::{Duration, Instant};

thread_local! {
    /// Bytes in use by this thread, and their largest number.
    static MEMORY: Cell<[isize; 2]> = const { Cell::new([0; 2]) };
}

struct Counting;

fn count(bytes: isize) {
    // Threads that end have no counter any more.
    let _ = MEMORY.try_with(|memory| {
        let [now, most] = memory.get();
        memory.set([now + bytes, most.max(now + bytes)]);
    });
}

#[expect(unsafe_code, reason = "an allocator is")]
// SAFETY: all work is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as asked for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as asked for.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Memory allowed for each byte of a file `[bytes]`. Lines of one character need 16 for their place.
const MEMORY_PER_BYTE: usize = 40;

/// Memory allowed for an empty file `[bytes]`.
const MEMORY_ANYHOW: usize = 1 << 16;

/// Time for a file of up to a MiB, on a machine that does other work too.
const LONGEST: Duration = Duration::from_secs(10);

fn survives(bytes: &[u8], seed: u64) {
    let units = Some(AccelerationUnit::CentimetrePerSecondSquared);
    let plain = TextOptions::default();
    let lenient = TextOptions { lenient: true, ..plain.clone() };
    let given = TextOptions { dt: Some(0.01), units, channel: Some(2), ..lenient.clone() };
    let table = TextOptions { skip_rows: 3, column: Some("2".into()), units, ..plain.clone() };
    for options in [plain, lenient, given, table] {
        MEMORY.with(|memory| memory.set([0; 2]));
        let begin = Instant::now();
        let read = RecordFile::read(bytes, &options);
        let [_, most] = MEMORY.with(Cell::get);
        assert!(begin.elapsed() < LONGEST, "seed {seed}: {:?}", begin.elapsed());
        assert!(most as usize <= MEMORY_ANYHOW + MEMORY_PER_BYTE * bytes.len(), "seed {seed}: {most} bytes");
        match read {
            Ok(file) => {
                let mut texts =
                    file.channels.iter().chain(&file.warnings).chain([&file.title, &file.station, &file.component]);
                assert!(texts.all(|text| !text.contains(char::is_control)), "seed {seed}: {file:?}");
                drop(texts);
                assert!(file.accel.iter().chain(&file.stated_peak).all(|a| a.is_finite()), "seed {seed}: {file:?}");
                assert!(file.dt > 0.0 && file.dt.is_finite(), "seed {seed}: {file:?}");
                let Ok(record) = file.into_record() else { continue };
                let measures = serde_json::to_value(record.measures(9.81)).expect("plain numbers");
                let is_number = |(name, value): (&String, &serde_json::Value)| value.is_f64() || name == "mean_period";
                let are_numbers = measures.as_object().expect("fields").iter().all(is_number);
                assert!(are_numbers, "seed {seed}: {measures}");
                let end = record.duration() + 1.0;
                let peaks = Motion::Record(record).peaks(0.0, end);
                assert!(peaks.iter().all(|peak| peak.is_finite()), "seed {seed}: {peaks:?}");
            }
            Err(error) => {
                let text = error.to_string();
                assert!(text.len() < 5000 && !text.contains(char::is_control), "seed {seed}: {text:?}");
            }
        }
    }
}

/// Parts of headers and rows, sound and absurd, separated by broken bars.
const SCRAPS: &str = "\u{1b}[31m¦-¦.¦E¦NaN¦9e999¦1e308¦-1e-320¦0¦\u{fc}¦\0¦:¦/&¦\n¦\n¦\r\n¦\x20¦\t¦,¦;¦#¦|¦(¦[¦7¦0.01¦-1.5E-2¦\
    NPTS= 9999999999999, DT= 1e-300¦NPTS=¦DT=¦NDATA: 3¦NDATA: 999999999¦SAMPLING_INTERVAL_S: 0.01¦UNITS: cm/s^2¦\
    PGA_CM/S^2: 1e308¦STREAM:¦(8F10.5)¦(Format v01.20 with 13 text lines)¦\
    100 Integer-header values follow on 10 lines, Format= (10I8)¦999999999 Real-header values follow¦\
    4 acceleration pts, approx 2 secs, units=g (02), Format=(8F10.5)¦End-of-data¦CORRECTED ACCELEROGRAM¦Chan 1: Up¦\
    3 points of accel data equally spaced at .01 sec, in cm/sec2. (8f10.6)¦Origin Time¦Sampling Freq(Hz) 1e-300Hz¦\
    Sampling Freq(Hz) 100Hz¦Scale Factor      3920(gal)/6182761¦Duration Time(s)  1e300¦Max. Acc. (gal) 1e300¦t [s]¦\
    a [g]";

/// Random choices from a seed.
struct Dice(Pcg64Mcg);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        (self.0.next_u64() % bound.max(1) as u64) as usize
    }

    fn scrap(&mut self) -> &'static [u8] {
        let place = self.below(SCRAPS.split('¦').count());
        SCRAPS.split('¦').nth(place).expect("there are so many").as_bytes()
    }

    /// The place of a line of a file.
    fn line(&mut self, bytes: &[u8]) -> std::ops::Range<usize> {
        let at = self.below(bytes.len());
        let start = bytes[..at].iter().rposition(|b| *b == b'\n').map_or(0, |place| place + 1);
        let end = bytes[at..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |place| at + place + 1);
        start..end
    }

    /// A file of scraps, of random bytes, or of a record file with up to seven changes.
    fn file(&mut self, files: &[Vec<u8>]) -> Vec<u8> {
        match self.below(10) {
            0 => return (0..self.below(400)).map(|_| self.0.next_u64() as u8).collect(),
            1 | 2 => return (0..self.below(60)).flat_map(|_| self.scrap().to_vec()).collect(),
            _ => {}
        }
        let mut bytes = files[self.below(files.len())].clone();
        for _ in 0..=self.below(6) {
            let at = self.below(bytes.len());
            match self.below(8) {
                _ if bytes.is_empty() => {}
                0 => bytes[at] = self.0.next_u64() as u8,
                1 => bytes.truncate(at),
                2 => drop(bytes.drain(self.line(&bytes))),
                3 | 4 => {
                    let line = self.line(&bytes);
                    let copies = bytes[line.clone()].repeat(1 << self.below(8));
                    bytes.splice(line.end..line.end, copies);
                }
                5 | 6 => drop(bytes.splice(at..at, self.scrap().iter().copied())),
                _ => {
                    let other = &files[self.below(files.len())];
                    let line = self.line(other);
                    bytes.splice(at..at, other[line].iter().copied());
                }
            }
        }
        bytes
    }
}

/// All record files of the tests.
fn files() -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/records")];
    while let Some(folder) = folders.pop() {
        let mut paths: Vec<_> =
            std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path()).collect();
        // The same order on every machine: seeds repeat.
        paths.sort();
        let (inner, files): (Vec<_>, Vec<_>) = paths.into_iter().partition(|path| path.is_dir());
        folders.extend(inner);
        found.extend(files.iter().map(|file| std::fs::read(file).expect("readable")));
    }
    assert!(found.len() > 25);
    found
}

fn damage(seeds: std::ops::Range<u64>) {
    let files = files();
    for seed in seeds {
        survives(&Dice(Pcg64Mcg::new(u128::from(seed) << 64 | u128::from(!seed))).file(&files), seed);
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    damage(0..2_000);
}

#[test]
#[ignore = "100,000 files take minutes"]
fn very_many_damaged_files_are_read_or_refused() {
    damage(2_000..102_000);
}

/// Repetitions on which a search within a search takes time like the square of the file's size.
#[test]
fn no_repetition_takes_long() {
    let head = "CORRECTED ACCELEROGRAM\n3 points of accel data equally spaced at .01 sec, in cm/sec2. ";
    let repeated = |head: &str, part: &str| format!("{head}{}", part.repeat((1 << 19) / part.len()));
    for text in [
        repeated(head, "("),
        repeated(head, "(8f10.6"),
        repeated("", "4 acceleration pts, units=g\n1 2 3 4\n"),
        repeated("", "3 points of accel data\n"),
        repeated("(Format v01.20 with 13 text lines)\n", "9 Real-header values follow\n"),
        repeated("t [s], ", "[ a "),
        repeated("t [s] ", "x "),
        repeated("", "t,"),
        repeated("", "1\n"),
        repeated("", "1,"),
        repeated("1 2\n", "0.1-0.2"),
        repeated("NPTS= 3, DT= .01\n", "1-"),
        repeated("NPTS= 9999999, DT= .01\n", "\n"),
        repeated("NPTS= 9999999, DT= .01\n", "1 2 3\n"),
        repeated("", ":\n"),
        repeated("Origin Time\n", "Sampling Freq(Hz) "),
        repeated("1", "0"),
        repeated("", "\""),
    ] {
        survives(text.as_bytes(), 0);
    }
}
