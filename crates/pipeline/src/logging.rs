//! What a person sees while the program works: log lines on stderr, a bar on a terminal, now and then a line elsewhere.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use tracing::level_filters::LevelFilter;
use tracing_indicatif::span_ext::IndicatifSpanExt;
use tracing_subscriber::Layer;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Without a terminal, progress is told this often.
const EVERY: Duration = Duration::from_secs(10);

/// How log lines look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum LogFormat {
    /// For people.
    Text,
    /// One JSON object a line.
    Json,
}

/// Starts logging to stderr. `verbosity` is 0 for what matters, more for more, negative for errors only.
pub fn start(format: LogFormat, verbosity: i8) {
    let own = match verbosity {
        ..=-1 => LevelFilter::ERROR,
        0 => LevelFilter::INFO,
        1 => LevelFilter::DEBUG,
        _ => LevelFilter::TRACE,
    };
    let filter = Targets::new().with_default(own.min(LevelFilter::WARN)).with_target("biplane", own);
    let terminal = std::io::stderr().is_terminal();
    let registry = tracing_subscriber::registry();
    // A second call in one process (tests) keeps the first one's subscriber.
    let _ = match (format, terminal && verbosity >= 0) {
        (LogFormat::Json, _) => registry
            .with(tracing_subscriber::fmt::layer().json().with_writer(std::io::stderr).with_filter(filter))
            .try_init(),
        (LogFormat::Text, true) => {
            let bars = tracing_indicatif::IndicatifLayer::new();
            let lines = tracing_subscriber::fmt::layer()
                .without_time()
                .with_target(false)
                .with_writer(bars.get_stderr_writer())
                .with_filter(filter);
            registry.with(lines).with(bars.with_filter(LevelFilter::INFO)).try_init()
        }
        (LogFormat::Text, false) => {
            let lines = tracing_subscriber::fmt::layer()
                .without_time()
                .with_target(false)
                .with_ansi(terminal)
                .with_writer(std::io::stderr)
                .with_filter(filter);
            registry.with(lines).try_init()
        }
    };
}

/// Counts items that are done.
pub struct Progress {
    span: tracing::Span,
    what: &'static str,
    unit: &'static str,
    total: usize,
    done: AtomicUsize,
    told: Mutex<Instant>,
    terminal: bool,
}

impl Progress {
    /// For `total` items, called `unit`; the bar shows until this is dropped.
    pub fn new(what: &'static str, total: usize, unit: &'static str) -> Self {
        let span = tracing::info_span!("progress");
        let terminal = std::io::stderr().is_terminal();
        if terminal {
            let template = format!("{{msg}} {{wide_bar:.green}} {{pos}}/{{len}} {unit}, {{eta}} to go");
            let style = indicatif::ProgressStyle::with_template(&template);
            span.pb_set_style(&style.unwrap_or_else(|_| indicatif::ProgressStyle::default_bar()));
            span.pb_set_length(total as u64);
            span.pb_set_message(what);
            span.pb_start();
        }
        let (done, told) = (AtomicUsize::new(0), Mutex::new(Instant::now()));
        Self { span, what, unit, total, done, told, terminal }
    }

    /// One more is done.
    pub fn tick(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.span.pb_inc(1);
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.terminal && told.elapsed() >= EVERY && done < self.total {
            *told = Instant::now();
            tracing::info!("{}: {done} of {} {}", self.what, self.total, self.unit);
        }
    }
}
