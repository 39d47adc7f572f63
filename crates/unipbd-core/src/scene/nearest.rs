//! Suggestions for misspelt words.

/// The candidate that `word` most likely stands for, if one is close: at most one slip (a letter
/// added, left out, replaced or two swapped) per three letters, upper and lower case alike; or else
/// the only one that begins with it.
///
/// ```
/// use unipbd_core::scene::nearest;
/// assert_eq!(nearest("densty", ["density", "cohesion"]), Some("density"));
/// assert_eq!(nearest("mass", ["density", "cohesion"]), None);
/// ```
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let word = letters(word);
    let slips = |candidate: &str| {
        let candidate = letters(candidate);
        let allowed = (word.len().max(candidate.len()) / 3).max(1);
        let hopeless = word.len().abs_diff(candidate.len()) > allowed || word.len() == 1 && candidate.len() == 1;
        (!hopeless).then(|| edit_distance(&word, &candidate)).filter(|&distance| distance <= allowed)
    };
    let scored = candidates.iter().filter_map(|&candidate| Some((slips(candidate)?, candidate)));
    let closest = scored.min_by_key(|&(distance, _)| distance).map(|(_, candidate)| candidate);
    closest.or_else(|| only_longer_form(&word, &candidates))
}

/// The only candidate that begins with `word`, for abbreviations of three letters and more.
fn only_longer_form<'a>(word: &[char], candidates: &[&'a str]) -> Option<&'a str> {
    let mut longer = candidates.iter().filter(|candidate| letters(candidate).starts_with(word));
    let first = longer.next().filter(|_| word.len() >= 3)?;
    longer.next().is_none().then_some(first)
}

fn letters(word: &str) -> Vec<char> {
    word.chars().flat_map(char::to_lowercase).collect()
}

/// Optimal string alignment distance: insertions, deletions, replacements, swaps of neighbours.
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before_last[j - 2] + 1);
            }
            row.push(best);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: &str, b: &str) -> usize {
        edit_distance(&letters(a), &letters(b))
    }

    #[test]
    fn distance_counts_each_kind_of_slip_once() {
        assert_eq!(distance("speed", "speed"), 0);
        assert_eq!(distance("sped", "speed"), 1);
        assert_eq!(distance("speeed", "speed"), 1);
        assert_eq!(distance("spead", "speed"), 1);
        assert_eq!(distance("psped", "speed"), 2);
        assert_eq!(distance("psEed", "speed"), 1);
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn far_words_are_not_suggested() {
        assert_eq!(nearest("colour", ["color", "name"]), Some("color"));
        assert_eq!(nearest("x", ["y", "z"]), None);
        assert_eq!(nearest("temperature", ["density", "name"]), None);
        assert_eq!(nearest("anything", []), None);
        assert_eq!(nearest("pos", ["position", "speed"]), Some("position"));
        assert_eq!(nearest("per", ["periodic_x", "periodic_y"]), None);
    }
}
