//! What the page needs once: the courts, the hoops, and the places with a name.

use crate::answers::json::in_si;
use crate::model::league_courts::League;
use crate::model::named_places::named_places;
use crate::model::{DEFAULT_PRESET, PRESETS};
use crate::report::court_record;
use axum::Json;
use serde_json::{Value, json};

pub(super) async fn start() -> Json<Value> {
    let league = League::Ncaa;
    let court = league.court();
    let physics = PRESETS.iter().map(|preset| {
        json!({
            "name": preset.name,
            "description": preset.description,
            "hoop": court_record(&court, &preset.physics()),
        })
    });
    let places = named_places(league).into_iter().map(
        |place| json!({ "name": place.name, "x_m": in_si(&place.x_m), "y_m": in_si(&place.y_m) }),
    );
    let default = PRESETS.iter().find(|preset| preset.name == DEFAULT_PRESET);
    let default = default.unwrap_or(&PRESETS[0]);
    Json(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "commit": env!("BANKSHOT_COMMIT"),
        "court": court_record(&court, &default.physics()),
        "physics": physics.collect::<Vec<_>>(),
        "places": places.collect::<Vec<_>>(),
    }))
}
