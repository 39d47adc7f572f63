//! Suggestions for misspelt words.

/// The candidate that `word` most likely stands for, if one is close: at most one slip (a letter
/// added, left out, replaced or two swapped) per three letters, upper and lower case alike; or else
/// the only one that begins with it.
///
/// ```
/// use unipbd_core::scene::nearest;
/// assert_eq!(nearest("densty", ["density", "surface_tension"]), Some("density"));
/// assert_eq!(nearest("mass", ["density", "surface_tension"]), None);
/// ```
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let word = word.to_lowercase();
    let length = word.chars().count();
    let slips = |candidate: &str| {
        let candidate = candidate.to_lowercase();
        let other = candidate.chars().count();
        let allowed = (length.max(other) / 3).max(1);
        let hopeless = length.abs_diff(other) > allowed || length == 1 && other == 1;
        (!hopeless).then(|| strsim::osa_distance(&word, &candidate)).filter(|&distance| distance <= allowed)
    };
    let scored = candidates.iter().filter_map(|&candidate| Some((slips(candidate)?, candidate)));
    let closest = scored.min_by_key(|&(distance, _)| distance).map(|(_, candidate)| candidate);
    closest.or_else(|| only_longer_form(&word, &candidates))
}

/// The only candidate that begins with `word`, for abbreviations of three letters and more.
fn only_longer_form<'a>(word: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let mut longer = candidates.iter().filter(|candidate| candidate.to_lowercase().starts_with(word));
    let first = longer.next().filter(|_| word.chars().count() >= 3)?;
    longer.next().is_none().then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

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
