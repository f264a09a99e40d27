//! The studio: raw bytes, or a request of the page with any body. Its commands do nothing.
#![no_main]

use bankshot::studio::{Commands, Finished, Studio, StudioOptions};
use libfuzzer_sys::fuzz_target;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::sync::LazyLock;
use std::time::Duration;

/// Host, port and token of a server that runs in this process.
static SERVER: LazyLock<(String, String)> = LazyLock::new(|| {
    let folder = tempfile::tempdir_in("/dev/shm").unwrap().keep();
    let options = StudioOptions {
        address: Ipv4Addr::LOCALHOST.into(),
        port: 0,
        folder,
    };
    let commands = Commands {
        run: |_, _| Finished::default(),
        stop: || std::panic::resume_unwind(Box::new(())),
    };
    let studio = Studio::open(&options, commands).unwrap();
    let url = studio.url();
    std::thread::spawn(move || studio.serve());
    let (host, token) = url["http://".len()..].split_once("/?token=").unwrap();
    (host.to_owned(), token.to_owned())
});

const REQUESTS: [&str; 16] = [
    "POST /api/answer",
    "POST /api/profile",
    "POST /api/jobs",
    "GET /api/folder",
    "PUT /api/uploads/a.csv",
    "POST /api/uploads/a.csv",
    "GET /api/fits/",
    "GET /api/sweeps/",
    "GET /files/",
    "DELETE /api/jobs/",
    "GET /",
    "GET /api/start",
    "POST /api/answer",
    "POST /api/jobs",
    "POST /api/uploads/",
    "PUT /api/uploads/",
];

fuzz_target!(|bytes: &[u8]| {
    let Some((which, bytes)) = bytes.split_first() else {
        return;
    };
    let (host, token) = &*SERVER;
    let mut stream = TcpStream::connect(host).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_millis(100)))
        .unwrap();
    let port = host.rsplit(':').next().unwrap();
    let head = |request: &str| {
        format!(
            "{request} HTTP/1.1\r\nhost: {host}\r\ncookie: bankshot_{port}={token}\r\nconnection: close\r\ncontent-type: application/json\r\n"
        )
    };
    let message = match which {
        0..=31 => bytes.to_vec(),
        32..=63 => [head("GET /").as_bytes(), bytes, b"\r\n\r\n"].concat(),
        _ => {
            let request = REQUESTS[usize::from(which % 16)];
            // What follows a slash is a name.
            let (name, body) = match request.ends_with('/') && request.len() > 5 {
                true => bytes.split_at(bytes.iter().position(|b| *b == b'\n').unwrap_or(bytes.len())),
                false => (&b""[..], bytes),
            };
            let name = String::from_utf8_lossy(name);
            let head = head(&format!("{request}{name}"));
            [
                head.as_bytes(),
                format!("content-length: {}\r\n\r\n", body.len()).as_bytes(),
                body,
            ]
            .concat()
        }
    };
    let _ = stream.write_all(&message);
    if *which < 64 {
        let _ = stream.shutdown(std::net::Shutdown::Write);
    }
    let mut answer = [0_u8; 4096];
    let count = stream.read(&mut answer).unwrap_or(0);
    if count > 0 {
        assert!(answer.starts_with(b"HTTP/1."));
        assert!(!answer.starts_with(b"HTTP/1.1 500"));
    }
});
