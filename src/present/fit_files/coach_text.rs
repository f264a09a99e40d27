//! What a coach tells a player, in a paragraph.

use super::advice_text::PlayerAdvice;
use super::fit_note_text::{WHAT_TO_CHECK, contradiction};
use crate::present::words::list;

/// A player's advice at a place, and the name of the place.
pub type AtPlace<'a> = (String, PlayerAdvice<'a>);

/// One paragraph for a player: what goes in now, and the change that gains most, in the numbers of
/// a gym.
#[must_use]
pub fn coach_paragraph(places: &[AtPlace<'_>]) -> String {
    let mut sentences = Vec::new();
    let (doubted, trusted): (Vec<&AtPlace>, Vec<&AtPlace>) = places
        .iter()
        .partition(|(_, advice)| advice.doubt.is_some());
    if let (true, Some(doubt)) = (
        trusted.is_empty(),
        doubted
            .first()
            .and_then(|(_, advice)| advice.doubt.as_ref()),
    ) {
        return format!("No advice yet: {}. {WHAT_TO_CHECK}", contradiction(doubt));
    }
    let now: Vec<String> = trusted
        .iter()
        .map(|(place, advice)| format!("{} from the {place}", advice.now()))
        .collect();
    if !now.is_empty() {
        sentences.push(format!(
            "Now {} go in (in brackets the 95 % interval).",
            list(&now)
        ));
    }
    let most = trusted
        .iter()
        .filter(|(_, advice)| advice.supported_gain() > 0.0)
        .max_by(|a, b| a.1.supported_gain().total_cmp(&b.1.supported_gain()));
    match (most, trusted.first()) {
        (Some((place, advice)), _) => {
            if trusted.len() > 1 {
                sentences.push(format!("Most to gain: the {place}."));
            }
            sentences.push(one_line(&advice.for_player()));
        }
        (None, Some((_, advice))) if trusted.len() == 1 => {
            sentences.push(one_line(&advice.for_player()));
        }
        (None, Some((_, advice))) => {
            sentences.push(
                "Keep the release everywhere for now: the shots support no change.".to_owned(),
            );
            sentences.extend(advice.training());
        }
        (None, None) => {}
    }
    let advised = most.map(|(place, _)| place);
    let others = trusted.iter().filter(|(place, _)| Some(place) != advised);
    if trusted.len() > 1 {
        sentences.extend(others.filter_map(|(place, advice)| {
            Some(format!("From the {place}: {}", advice.better_kind()?))
        }));
    }
    sentences.extend(doubted.iter().map(|(place, _)| {
        format!(
            "No advice for the {place} yet: the makes contradict the measured shots (`bankshot fit`)."
        )
    }));
    sentences.join(" ")
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
