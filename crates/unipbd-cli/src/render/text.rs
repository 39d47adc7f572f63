//! Letters made of lines on a small grid, drawn as anti-aliased strokes at any size.

use tiny_skia::PathBuilder;

use super::color::Rgb;
use super::paper::Paper;

/// Where a text stands relative to its anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Center,
    Right,
}

/// Grid units from the base line (2) to the top of a capital (8).
const CAPITAL: f32 = 6.0;
const BASE: f32 = 2.0;
/// Free space between letters in grid units.
const GAP: f32 = 2.2;

/// Width and strokes of a letter. Points are digits x, y; `o` closes a stroke, `s` keeps its
/// corners sharp, `d` is a dot; other corners are rounded.
fn glyph(letter: char) -> (u8, &'static str) {
    match letter {
        ' ' => (1, ""),
        '0' => (4, "o02424808"),
        '1' => (2, "s062822"),
        '2' => (4, "0708484502;s0242"),
        '3' => (4, "0708484525;2545420203"),
        '4' => (4, "s280444;s3632"),
        '5' => (4, "s480805;0545420203"),
        '6' => (4, "47480802424505"),
        '7' => (4, "s084812"),
        '8' => (4, "o05454808;o05454202"),
        '9' => (4, "03024248080545"),
        'a' => (4, "o02424606;s4642"),
        'b' => (4, "o02424606;s0802"),
        'c' => (4, "454606024243"),
        'd' => (4, "o02424606;s4842"),
        'e' => (4, "s0444;4446060242"),
        'f' => (3, "381812;s0636"),
        'g' => (4, "o02424606;464000"),
        'h' => (4, "s0802;064642"),
        'i' => (0, "s0206;d08"),
        'j' => (1, "161000;d18"),
        'k' => (3, "s0802;s360432"),
        'l' => (1, "080212"),
        'm' => (6, "s0602;063632;366662"),
        'n' => (4, "s0602;064642"),
        'o' => (4, "o02424606"),
        'p' => (4, "o02424606;s0600"),
        'q' => (4, "o02424606;s4640"),
        'r' => (3, "s0602;040636"),
        's' => (4, "4546060444420203"),
        't' => (3, "181232;s0636"),
        'u' => (4, "06024246;s4642"),
        'v' => (4, "s062246"),
        'w' => (6, "s0612355266"),
        'x' => (4, "s0642;s0246"),
        'y' => (4, "s0622;s4610"),
        'z' => (4, "s06460242"),
        'A' => (4, "s022842;s1434"),
        'B' => (4, "s0208;08484505;05454202"),
        'C' => (4, "474808024243"),
        'D' => (4, "s0208;08484202"),
        'E' => (4, "s48080242;s0535"),
        'F' => (4, "s480802;s0535"),
        'G' => (4, "47480802424525"),
        'H' => (4, "s0208;s4248;s0545"),
        'I' => (0, "s0208"),
        'J' => (3, "38320203"),
        'K' => (4, "s0208;s480542"),
        'L' => (4, "s080242"),
        'M' => (6, "s0208346862"),
        'N' => (4, "s02084248"),
        'O' => (4, "o02424808"),
        'P' => (4, "s0208;08484505"),
        'Q' => (4, "o02424808;s2341"),
        'R' => (4, "s0208;08484505;s2542"),
        'S' => (4, "4748080545420203"),
        'T' => (4, "s0848;s2822"),
        'U' => (4, "08024248"),
        'V' => (4, "s082248"),
        'W' => (6, "s0812365268"),
        'X' => (4, "s0842;s0248"),
        'Y' => (4, "s082548;s2522"),
        'Z' => (4, "s08480242"),
        '.' => (0, "d02"),
        ',' => (1, "s1200"),
        ':' => (0, "d02;d06"),
        '-' => (3, "s0535"),
        '_' => (4, "s0141"),
        '+' => (4, "s0545;s2327"),
        '=' => (4, "s0444;s0646"),
        '/' => (3, "s0138"),
        '[' => (1, "s19090111"),
        ']' => (1, "s09191101"),
        '(' => (1, "19080211"),
        ')' => (1, "09181201"),
        '%' => (5, "o06262808;o32525434;s0258"),
        '^' => (4, "s062846"),
        '\'' => (0, "s0806"),
        _ => (4, "so02424808"),
    }
}

/// Width of a line of text in grid units.
fn grid_width(text: &str) -> f32 {
    text.chars().map(|letter| f32::from(glyph(letter).0) + GAP).sum::<f32>() - GAP
}

/// Width of a line of text with capitals of this height [pixels].
pub(super) fn width(text: &str, height: f32) -> f32 {
    grid_width(text) * height / CAPITAL
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lettering {
    /// Height of a capital in pixels.
    pub height: f32,
    /// Where it stands relative to its anchor.
    pub align: Align,
    /// Colour of the lines.
    pub color: Rgb,
    /// Colour of a rim that keeps the text readable on anything.
    pub halo: Rgb,
}

/// Draws a line of text whose anchor lies on the base line [pixels].
pub(super) fn draw(paper: &mut dyn Paper, text: &str, anchor: [f32; 2], lettering: Lettering) {
    let Lettering { height, align, color, halo } = lettering;
    let unit = height / CAPITAL;
    let shift = match align {
        Align::Left => 0.0,
        Align::Center => 0.5,
        Align::Right => 1.0,
    };
    let mut left = anchor[0] - shift * grid_width(text) * unit;
    let mut path = PathBuilder::new();
    for letter in text.chars() {
        let (width, strokes) = glyph(letter);
        for stroke in strokes.split(';').filter(|stroke| !stroke.is_empty()) {
            add_stroke(&mut path, stroke, |x, y| [left + x * unit, anchor[1] - (y - BASE) * unit]);
        }
        left += (f32::from(width) + GAP) * unit;
    }
    if let Some(path) = path.finish() {
        let width = (0.95 * unit).max(1.1);
        paper.stroke(&path, halo, width + 2.0 * unit);
        paper.stroke(&path, color, width);
    }
}

fn add_stroke(path: &mut PathBuilder, stroke: &str, place: impl Fn(f32, f32) -> [f32; 2]) {
    let flags = stroke.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits: Vec<f32> = stroke.bytes().filter(u8::is_ascii_digit).map(|digit| f32::from(digit - b'0')).collect();
    let points: Vec<[f32; 2]> = digits.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let mut to = |command: Command, [x, y]: [f32; 2]| {
        let [x, y] = place(x, y);
        match command {
            Command::Move => path.move_to(x, y),
            Command::Line => path.line_to(x, y),
            Command::Bend([cx, cy]) => {
                let [cx, cy] = place(cx, cy);
                path.quad_to(cx, cy, x, y);
            }
        }
    };
    if flags.contains('d') {
        // A dot is a stroke too short to see but for its round ends.
        to(Command::Move, points[0]);
        return to(Command::Line, [points[0][0], points[0][1] + 0.05]);
    }
    let roundness = if flags.contains('s') { 0.0 } else { 1.8 };
    let closed = flags.contains('o');
    let count = points.len();
    let start = if closed { middle(points[count - 1], points[0]) } else { points[0] };
    to(Command::Move, start);
    let corners = if closed { 0..count } else { 1..count - 1 };
    for corner in corners {
        let [before, here, after] =
            [points[(corner + count - 1) % count], points[corner], points[(corner + 1) % count]];
        to(Command::Line, toward(here, before, roundness));
        to(Command::Bend(here), toward(here, after, roundness));
    }
    to(Command::Line, if closed { start } else { points[count - 1] });
}

enum Command {
    Move,
    Line,
    Bend([f32; 2]),
}

fn middle(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]
}

/// The point `distance` from a corner towards another, at most half way.
fn toward(corner: [f32; 2], other: [f32; 2], distance: f32) -> [f32; 2] {
    let [dx, dy] = [other[0] - corner[0], other[1] - corner[1]];
    let t = (distance / dx.hypot(dy)).min(0.5);
    [corner[0] + t * dx, corner[1] + t * dy]
}
