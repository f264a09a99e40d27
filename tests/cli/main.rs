//! The program from outside: answers, files, bad input and exit codes.
#![cfg(feature = "app")]

mod best;
mod check;
mod compare_sessions;
mod design;
mod doc_outputs;
mod fit;
mod help_examples;
mod man;
mod new;
mod output_file_errors;
mod probability;
mod schema;
mod silent_guesses;
mod simulate;
mod stored;
mod support;
mod table;
mod team;
mod trace;
