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
    /// A sentence for the poster; empty where nothing is to be changed.
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
        let (observed, angle) = (Some(fit.observed[0]), location.angle_rad);
        let player = present::PlayerAdvice {
            profile,
            advice: &advice,
            observed,
            units,
        };
        let from = location.in_words(units);
        let further_places = fit.profiles.len() - 1;
        let mut poster = advice_for_poster(&advice, observed, (&from, angle), units);
        if further_places == 0 && !poster.is_empty() {
            poster +=
                " (You were measured only there; the map assumes the same scatter everywhere.)";
        }
        Ok(Self {
            text: player.for_player(),
            poster,
            short: short_advice(&advice, observed, angle, units),
            from,
            further_places,
        })
    }
}
