//! Unknown words, and the known ones that may have been meant.

use strsim::damerau_levenshtein;

/// Message about a `word` that is not among the `known` ones.
pub(crate) fn unknown(word: &str, known: &[&str]) -> String {
    match (nearest(word, known), known) {
        (_, []) => "there are none".into(),
        (Some(nearest), [_]) => format!("did you mean \"{nearest}\"?"),
        (Some(nearest), _) => format!("did you mean \"{nearest}\"? Known: {}", list(known)),
        (None, _) => format!("known: {}", list(known)),
    }
}

/// The same, where the known words name all `what` (springs, node sets) that the `owner` (scene, mesh) has.
pub(crate) fn unknown_among(word: &str, known: &[&str], owner: &str, what: &str) -> String {
    match (nearest(word, known), known) {
        (_, []) => format!("the {owner} has no {what}"),
        (Some(nearest), _) => {
            format!("did you mean \"{nearest}\"? The {owner} has the {what} {}", list(known))
        }
        (None, _) => format!("the {owner} has the {what} {}", list(known)),
    }
}

/// The words in quotes.
pub(crate) fn list(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}

/// The known word that begins with `word`, or else the one that differs from it by the fewest typing errors,
/// if these are fewer than half the letters of the longer word.
fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > 2
        && let Some(whole) = known.iter().find(|known| known.starts_with(word))
    {
        return Some(whole);
    }
    let errors = |known: &str| damerau_levenshtein(&word.to_lowercase(), &known.to_lowercase());
    let best = known.iter().copied().min_by_key(|known| errors(known))?;
    let length = word.chars().count().max(best.chars().count());
    (2 * errors(best) < length).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typing_errors_are_understood() {
        let known = ["density", "young", "poisson", "viscosity"];
        assert_eq!(nearest("yuong", &known), Some("young"));
        assert_eq!(nearest("Poison", &known), Some("poisson"));
        assert_eq!(nearest("colour", &known), None);
        assert_eq!(nearest("x", &[]), None);
    }
}
