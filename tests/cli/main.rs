//! The program from outside: answers, files, bad input and exit codes.
#![cfg(feature = "app")]

mod best;
mod check;
mod compare;
mod doc_outputs;
mod fit;
mod help_examples;
mod hostile_files;
mod hostile_names;
mod kills;
mod man;
mod new;
mod output_file_errors;
mod plain_words;
mod sample_size;
mod schema;
mod shot;
mod shot_files;
mod silent_guesses;
mod simulate;
mod stored;
mod support;
mod table;
mod team;
mod trace;
