//! The studio: the engine behind a page in the browser.
//!
//! A server inside the program answers the requests of one page, from this machine alone. It
//! computes nothing of its own: questions go to [`crate::answers`], long work runs commands, and
//! what they write stays in the folder that the studio was started in.
//!
//! | path | what |
//! |---|---|
//! | `GET /api/start` | the courts, the hoops and the places with a name |
//! | `POST /api/answer` | a question ([`crate::answers::requests::Request`]); a draft and the answer, one JSON object a line |
//! | `POST /api/profile` | the text of a profile with other values |
//! | `GET /api/folder` | what is in the folder |
//! | `PUT /api/uploads/NAME` | a file of measured shots |
//! | `POST /api/uploads/NAME` | what the file holds |
//! | `GET /api/fits/NAME`, `/api/sweeps/NAME` | a fit, a sweep with the results so far |
//! | `GET`, `POST /api/jobs`, `DELETE /api/jobs/ID` | long work |
//! | `GET /api/events` | the jobs, again with each change |
//! | `GET /files/NAME` | a file of the folder |
//!
//! `docs/studio.openapi.json` has the types.

mod access;
mod folder;
mod jobs;
#[cfg(test)]
mod openapi;
mod page_files;
mod questions;
mod refusal;
mod results;
mod server;
mod site;
mod start;
mod uploads;

pub use jobs::{Commands, Finished};
pub use server::{Studio, StudioOptions};
