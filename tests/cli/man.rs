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
    for command in ["best", "compare", "simulate", "sweep", "report", "man"] {
        let text = page(&[command]);
        assert!(text.stdout().contains("OPTIONS"), "{text:?}");
        assert_eq!(text.stdout().matches("(1)").count(), 0, "{text:?}");
    }
    let mut command = bankshot();
    Answer::of(command.args(["man", "help"])).exits(2);
    let mut command = bankshot();
    Answer::of(command.args(["man", "bets"]))
        .exits(2)
        .says("there is no such command");
}
