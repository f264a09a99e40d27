//! `man`: the manual pages.

use super::support::{Answer, bankshot};

#[test]
fn contract_the_manual_cites_only_pages_that_exist() {
    let page = |arguments: &[&str]| {
        let mut command = bankshot();
        Answer::of(command.arg("man").args(arguments)).exits(0)
    };
    let main = page(&[]);
    let text = main.stdout();
    assert!(text.contains("bankshot man best"), "{text}");
    // The title line is the only `name(1)`.
    assert_eq!(text.matches("(1)").count(), 0, "{text}");
    let best = page(&["best"]);
    assert!(best.stdout().contains("profile"), "{best:?}");
    let mut command = bankshot();
    Answer::of(command.args(["man", "bets"]))
        .exits(2)
        .says("there is no such command");
}
