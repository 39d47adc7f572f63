//! The maps of what is stable as a page of markdown and as one picture.

use std::fmt::Write;

use super::map::{Cell, Map, SUBSTEPS};

/// Heading of the section in the accuracy sheet.
pub const HEADING: &str = "What is stable";
/// Where the picture lies, seen from the sheet.
pub const PICTURE: &str = "images/stability.svg";

/// A map with its cells by row.
pub type Surveyed<'a> = (&'a Map, Vec<Vec<Cell>>);

/// The body of the section.
pub fn section(maps: &[Surveyed<'_>]) -> String {
    let mut text = format!(
        "Made by `cargo run --release -p unipbd-validation -- --map`, {}. Each cell is a run with this many substeps per \
         frame (`auto`: at most 64, in brackets what it took): its worst density error C, and by how much its energy \
         rose over that of the start where that is more than 0.5 %. All cells without a word are finite and \
         contained; a word says what happened to the others.\n\n![worst C and growth of energy]({PICTURE})\n",
        crate::stamp::stamp()
    );
    for (map, rows) in maps {
        let _ = write!(text, "\n{}, by {}:\n\n| {} |", capital(map.setup), map.name, map.name);
        SUBSTEPS.iter().for_each(|substeps| {
            let _ = write!(text, " n = {substeps} |");
        });
        text.push_str(" auto |\n|");
        text.push_str(&"---|".repeat(SUBSTEPS.len() + 2));
        for (value, cells) in map.rows.iter().zip(rows) {
            let _ = write!(text, "\n| {value} |");
            for (column, cell) in cells.iter().enumerate() {
                let _ = write!(text, " {} |", words(cell, column == SUBSTEPS.len()));
            }
        }
        text.push('\n');
    }
    text
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// `1.2 %`, `14 %, energy +3 %` or what broke.
fn words(cell: &Cell, auto: bool) -> String {
    if let Some(what) = &cell.broken {
        return format!("**{what}**");
    }
    let mut text = percent(cell.worst);
    if !cell.is_sound() {
        let _ = write!(text, ", energy +{}", percent(cell.gain));
    }
    if auto {
        let _ = write!(text, " ({})", cell.substeps);
    }
    text
}

fn percent(part: f64) -> String {
    let value = 100.0 * part;
    if value < 9.95 { format!("{value:.1} %") } else { format!("{value:.0} %") }
}

const TILE: (f64, f64) = (64.0, 30.0);
const LEFT: f64 = 60.0;
const TOP: f64 = 64.0;
const GAP: f64 = 46.0;

/// The picture: a tile per cell, green to red by the worst C; energy that grows is marked by a ring,
/// broken runs are black.
pub fn picture(maps: &[Surveyed<'_>]) -> String {
    let columns = SUBSTEPS.len() + 1;
    let rows: usize = maps.iter().map(|(map, _)| map.rows.len()).sum();
    let width = LEFT + TILE.0 * columns as f64 + 20.0;
    let height = TOP + TILE.1 * rows as f64 + (GAP + 20.0) * maps.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"12\" y=\"22\" \
         font-size=\"16\">Worst C by substeps per frame</text>\n<text x=\"12\" y=\"40\" fill=\"#555\">ring: energy \
         grows by more than 0.5 %; black: leaves its tank, stops, or is not finite</text>\n"
    );
    let mut y = TOP;
    for (map, cells) in maps {
        let _ = writeln!(svg, "<text x=\"12\" y=\"{:.0}\" font-weight=\"bold\">{}</text>", y + 14.0, map.name);
        y += 22.0;
        for (value, row) in map.rows.iter().zip(cells) {
            let _ = writeln!(
                svg,
                "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"end\">{value}</text>",
                LEFT - 6.0,
                y + 0.65 * TILE.1
            );
            row.iter().enumerate().for_each(|(column, cell)| tile(&mut svg, LEFT + TILE.0 * column as f64, y, cell));
            y += TILE.1;
        }
        for column in 0..columns {
            let name = SUBSTEPS.get(column).map_or("auto".to_owned(), |substeps| format!("n = {substeps}"));
            let x = LEFT + TILE.0 * (column as f64 + 0.5);
            let _ = writeln!(svg, "<text x=\"{x:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{name}</text>", y + 16.0);
        }
        y += GAP;
    }
    svg.push_str("</svg>\n");
    svg
}

fn tile(svg: &mut String, x: f64, y: f64, cell: &Cell) {
    let (fill, ink) = if cell.broken.is_some() { ("#222".to_owned(), "#fff") } else { (color(cell.worst), "#222") };
    let ring = if cell.broken.is_none() && !cell.is_sound() { "#a00" } else { "#fff" };
    let _ = writeln!(
        svg,
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"4\" fill=\"{fill}\" stroke=\"{ring}\" \
         stroke-width=\"2\"/>",
        x + 2.0,
        y + 2.0,
        TILE.0 - 4.0,
        TILE.1 - 4.0
    );
    let text = if cell.broken.is_some() { "broken".to_owned() } else { percent(cell.worst) };
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{ink}\">{text}</text>",
        x + 0.5 * TILE.0,
        y + 0.65 * TILE.1
    );
}

/// Green at 1 % and below, yellow at 10 %, red at 100 % and above.
fn color(worst: f64) -> String {
    const STOPS: [[f64; 3]; 3] = [[134.0, 201.0, 140.0], [245.0, 214.0, 110.0], [230.0, 120.0, 104.0]];
    let place = (worst.max(1e-9).log10() + 2.0).clamp(0.0, 2.0);
    let (from, part) = if place < 1.0 { (0, place) } else { (1, place - 1.0) };
    let mix = |channel: usize| STOPS[from][channel] * (1.0 - part) + STOPS[from + 1][channel] * part;
    format!("rgb({:.0},{:.0},{:.0})", mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::super::map::MAPS;
    use super::*;

    #[test]
    fn every_cell_is_in_the_table_and_in_the_picture() {
        let cell =
            |worst, gain, broken: Option<&str>| Cell { substeps: 5, worst, gain, broken: broken.map(str::to_owned) };
        let row = vec![
            cell(0.012, 0.0, None),
            cell(0.5, 0.4, None),
            cell(0.0, 0.0, Some("stops: here")),
            cell(0.1, 0.0, None),
            cell(0.1, 0.0, None),
            cell(0.1, 0.0, None),
            cell(0.25, 0.0, None),
        ];
        let rows = vec![row; MAPS[0].rows.len()];
        let maps = [(&MAPS[0], rows)];
        let text = section(&maps);
        assert!(text.contains("| 1 | 1.2 % | 50 %, energy +40 % | **stops: here** | 10 % |"), "{text}");
        assert!(text.contains(" 25 % (5) |"), "{text}");
        assert_eq!(picture(&maps).matches("rx=\"4\"").count(), 7 * MAPS[0].rows.len());
    }
}
