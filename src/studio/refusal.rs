//! Why a request is refused.

use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// What is wrong, and at which field of the request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Fault {
    /// The field, such as `speed`; `None` where no single one is meant.
    pub(super) field: Option<String>,
    /// What is wrong, and what to write.
    pub(super) message: String,
}

/// A request that is refused.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Refusal {
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    status: StatusCode,
    /// What is wrong.
    errors: Vec<Fault>,
}

impl Refusal {
    pub(super) fn new(status: StatusCode, message: impl Into<String>) -> Self {
        let fault = Fault {
            field: None,
            message: message.into(),
        };
        Self {
            status,
            errors: vec![fault],
        }
    }

    pub(super) fn bad(message: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, message)
    }

    pub(super) fn field(field: &str, message: impl Into<String>) -> Self {
        Self::fields(vec![Fault {
            field: Some(field.to_owned()),
            message: message.into(),
        }])
    }

    pub(super) fn fields(errors: Vec<Fault>) -> Self {
        Self {
            status: StatusCode::BAD_REQUEST,
            errors,
        }
    }

    pub(super) fn forbidden(message: impl Into<String>) -> Self {
        Self::new(StatusCode::FORBIDDEN, message)
    }

    pub(super) fn not_found(what: &str) -> Self {
        Self::new(
            StatusCode::NOT_FOUND,
            format!("{what}: there is no such thing in the folder"),
        )
    }

    pub(super) fn io(what: &str, error: &std::io::Error) -> Self {
        Self::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            format!("{what}: {error}"),
        )
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let messages = self.errors.iter().map(|fault| match &fault.field {
            Some(field) => format!("{field}: {}", fault.message),
            None => fault.message.clone(),
        });
        f.write_str(&messages.collect::<Vec<_>>().join("\n"))
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let status = self.status;
        (status, axum::Json(self)).into_response()
    }
}
