//! The server: its address, its routes, and its connections.

use super::jobs::{Commands, Jobs};
use super::questions::Questions;
use super::site::Site;
use super::{access, folder, jobs, page_files, questions, results, start, uploads};
use axum::Router;
use axum::extract::{DefaultBodyLimit, FromRef};
use axum::middleware;
use axum::routing::{delete, get, post, put};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::io;
use std::net::IpAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Connections at a time; others wait.
const MAX_CONNECTIONS: usize = 256;
/// A client has this long to send the head of a request.
const HEAD_TIMEOUT: Duration = Duration::from_secs(10);
/// The longest request but an upload, bytes.
const MAX_REQUEST: usize = 1 << 20;

/// Where the studio is, and what it works with.
#[derive(Clone, Debug)]
pub struct StudioOptions {
    /// The address to listen on.
    pub address: IpAddr,
    /// The port; the next free one if it is taken, and any for 0.
    pub port: u16,
    /// The folder of the results.
    pub folder: PathBuf,
}

/// What the requests share, each what it needs.
#[derive(Clone)]
struct Shared {
    site: Arc<Site>,
    questions: Arc<Questions>,
    jobs: Arc<Jobs>,
}

impl FromRef<Shared> for Arc<Site> {
    fn from_ref(shared: &Shared) -> Self {
        Arc::clone(&shared.site)
    }
}

impl FromRef<Shared> for Arc<Questions> {
    fn from_ref(shared: &Shared) -> Self {
        Arc::clone(&shared.questions)
    }
}

impl FromRef<Shared> for Arc<Jobs> {
    fn from_ref(shared: &Shared) -> Self {
        Arc::clone(&shared.jobs)
    }
}

/// A server that is ready to answer.
pub struct Studio {
    listener: std::net::TcpListener,
    shared: Shared,
}

/// A number that nobody can guess, in hexadecimal digits.
fn random_token() -> io::Result<String> {
    let mut bytes = [0_u8; 16];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// The first free port from the wanted one on.
fn bind(address: IpAddr, port: u16) -> io::Result<std::net::TcpListener> {
    /// Ports that are tried.
    const TRIED: u16 = 20;
    let last = if port == 0 {
        0
    } else {
        port.saturating_add(TRIED - 1)
    };
    let mut refused = None;
    for port in port..=last {
        match std::net::TcpListener::bind((address, port)) {
            Ok(listener) => return Ok(listener),
            Err(error) => refused = Some(error),
        }
    }
    Err(refused.unwrap_or_else(|| io::ErrorKind::AddrInUse.into()))
}

impl Studio {
    /// Takes an address and makes the folder.
    ///
    /// # Errors
    /// No port is free, or the folder cannot be made.
    pub fn open(options: &StudioOptions, commands: Commands) -> io::Result<Self> {
        std::fs::create_dir_all(&options.folder)?;
        let listener = bind(options.address, options.port)?;
        listener.set_nonblocking(true)?;
        let site = Site {
            address: listener.local_addr()?,
            token: random_token()?,
            folder: options.folder.clone(),
        };
        let shared = Shared {
            site: Arc::new(site),
            questions: Arc::default(),
            jobs: Arc::new(Jobs::new(commands, options.folder.clone())),
        };
        Ok(Self { listener, shared })
    }

    /// The address to open, with the token of this start.
    #[must_use]
    pub fn url(&self) -> String {
        let address = self.shared.site.address;
        let host = match address.ip() {
            ip if ip.is_unspecified() => "127.0.0.1".to_owned(),
            IpAddr::V6(ip) => format!("[{ip}]"),
            IpAddr::V4(ip) => ip.to_string(),
        };
        format!(
            "http://{host}:{}/?token={}",
            address.port(),
            self.shared.site.token
        )
    }

    /// Answers until the process ends.
    ///
    /// # Errors
    /// The listener fails.
    pub fn serve(self) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .build()?;
        runtime.block_on(async move {
            let listener = TcpListener::from_std(self.listener)?;
            accept(&listener, routes(self.shared)).await
        })
    }
}

fn routes(shared: Shared) -> Router {
    Router::new()
        .route("/", get(page_files::page))
        .route("/studio.js", get(page_files::script))
        .route("/studio.css", get(page_files::style))
        .route("/api/start", get(start::start))
        .route("/api/answer", post(questions::answer))
        .route("/api/profile", post(questions::profile))
        .route("/api/folder", get(folder::content))
        .route("/api/fits/{*name}", get(results::fit))
        .route("/api/sweeps/{*name}", get(results::sweep))
        .route("/api/uploads/{name}", post(uploads::content))
        .route("/api/jobs", get(jobs::list).post(jobs::add))
        .route("/api/jobs/{id}", delete(jobs::stop))
        .route("/api/events", get(jobs::events))
        .route("/files/{*name}", get(folder::file))
        .layer(DefaultBodyLimit::max(MAX_REQUEST))
        .route(
            "/api/uploads/{name}",
            put(uploads::receive).layer(DefaultBodyLimit::disable()),
        )
        .layer(middleware::from_fn_with_state(
            Arc::clone(&shared.site),
            access::guard,
        ))
        .with_state(shared)
}

/// Takes connections, each in a task of its own.
async fn accept(listener: &TcpListener, routes: Router) -> io::Result<()> {
    let free = Arc::new(Semaphore::new(MAX_CONNECTIONS));
    loop {
        let Ok(place) = Arc::clone(&free).acquire_owned().await else {
            return Ok(());
        };
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            // One connection failed, or the process has no more files: neither ends the server.
            Err(_) => {
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            }
        };
        // Answers are small and must not wait for each other.
        let _ = stream.set_nodelay(true);
        let service = TowerToHyperService::new(routes.clone());
        tokio::spawn(async move {
            let connection = hyper::server::conn::http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(HEAD_TIMEOUT)
                .serve_connection(TokioIo::new(stream), service);
            // A client that breaks off is no error of the server.
            let _ = connection.await;
            drop(place);
        });
    }
}
