//! What the measured shots of a player say.

use crate::cli::failure::Failure;
use crate::fitting::advise;
use crate::present::fit_files::advice_for_team::{ShortAdvice, advice_for_poster, short_advice};
use crate::present::fit_files::advice_text as present;
use crate::probability::Progress;
use crate::shooter::OutputSettings;
use crate::store::fit::Fit;

/// What a fitted player's own shots say, at the first place of the fit.
pub(super) struct PlayerAdvice {
    /// A paragraph. (That the other kind is no better from there is no news on a page about
    /// banking.)
    pub(super) text: String,
    /// A sentence for the poster.
    pub(super) poster: String,
    /// For a row of a table.
    pub(super) short: ShortAdvice,
    /// Where the shots were from.
    pub(super) from: String,
    /// Further places of the fit, whose advice is not here.
    pub(super) further_places: usize,
}

impl PlayerAdvice {
    /// At the first place of the fit.
    pub(super) fn of_fit(
        fit: &Fit,
        output: &OutputSettings,
        progress: &dyn Progress,
    ) -> Result<Self, Failure> {
        let (profile, units) = (&fit.profiles[0], output.units);
        let advice = advise(profile, &fit.posterior, 0, progress)?;
        let location = profile.location();
        let angle = location.angle_rad;
        let doubt = fit.contradiction(0, &advice.usual_probability);
        let is_doubted = doubt.is_some();
        let player = present::PlayerAdvice {
            profile,
            advice: &advice,
            observed: fit.observed[0],
            doubt,
            units,
        };
        let from = match fit.place_names[0].as_str() {
            "" => location.in_words(units),
            name => name.to_owned(),
        };
        let further_places = fit.profiles.len() - 1;
        let mut poster = advice_for_poster(&advice, is_doubted, (&from, angle), units);
        if further_places == 0 && !is_doubted {
            poster +=
                " (You were measured only there; the map assumes the same scatter everywhere.)";
        }
        Ok(Self {
            text: player.for_player(),
            poster,
            short: short_advice(&advice, is_doubted, angle, units),
            from,
            further_places,
        })
    }
}
