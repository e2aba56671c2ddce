//! How long it takes to find out that nothing needs to run: `cargo run -p biplane-stage --example lookups [items]`.
//!
//! Fills a store in a temporary folder, then looks every item up again, on one thread and then on as many as there are
//! cores, as a second run of a study does.

use std::convert::Infallible;
use std::error::Error;
use std::ops::Range;
use std::time::Instant;

use biplane_artifact::{Content, ContentHash, ContentHasher, Picture};
use biplane_stage::{Context, ExecuteError, Hashed, How, Inputs, Item, ParamsText, Stage, Store, inputs};
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy)]
struct Number(u32);

impl Content for Number {
    const KIND: &'static str = "number";
    const SCHEMA: u32 = 1;
    fn content_hash(&self) -> ContentHash {
        ContentHasher::new(Self::KIND, Self::SCHEMA).unsigned(u64::from(self.0)).finish()
    }
}

inputs! {
    struct OverlayInputs { curves: [Number], calibrations: [Number], model: Number, start: Number }
}

#[derive(Serialize, Deserialize)]
struct Params {
    smoothing_px: f64,
    radius_mm: f64,
    views: Vec<String>,
}

struct Overlay;

impl Stage for Overlay {
    const NAME: &'static str = "overlay";
    const CODE: &'static str = "example";
    type Inputs = OverlayInputs;
    type Params = Params;
    type Output = Picture;
    type Error = Infallible;
    fn run(_: &OverlayInputs, _: &Params, _: &Context) -> Result<Picture, Infallible> {
        Ok(Picture(b"\x89PNG\r\n\x1a\n".repeat(8)))
    }
}

fn loaded(i: u32) -> OverlayInputs {
    let number = |n| Hashed::new(Number(n));
    OverlayInputs {
        curves: vec![number(2 * i), number(2 * i + 1)],
        calibrations: vec![number(0), number(1)],
        model: number(2),
        start: number(i),
    }
}

type Failure = ExecuteError<Infallible, Infallible>;

fn main() -> Result<(), Box<dyn Error>> {
    let items: u32 = std::env::args().nth(1).map_or(Ok(60_000), |n| n.parse())?;
    let folder = tempfile::tempdir()?;
    let store = Store::open(&folder.path().join(".biplane"))?;
    let views = vec!["A".to_owned(), "B".to_owned()];
    let params = ParamsText::of(&Params { smoothing_px: 1.5, radius_mm: 10.0, views })?;
    let context = Context::new();
    let run = |range: Range<u32>| -> Result<u32, Failure> {
        let mut cached = 0;
        for i in range {
            let item =
                Item::of([format!("trial {}", i / 1000), format!("{:04}", i % 1000), "femur".to_owned()]);
            let load = || Ok::<_, Infallible>(loaded(i));
            let hashes = loaded(i).hashes();
            let outcome = store.execute::<Overlay, _>("overlay", &item, &params, &hashes, load, &context)?;
            cached += u32::from(outcome.how == How::Cached);
        }
        Ok(cached)
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from) as u32;
    for threads in [1, 1, cores] {
        let started = Instant::now();
        let cached = std::thread::scope(|scope| {
            let share = |t: u32| t * items / threads..(t + 1) * items / threads;
            let workers: Vec<_> = (0..threads).map(|t| scope.spawn(move || run(share(t)))).collect();
            workers.into_iter().map(|w| w.join().unwrap_or(Ok(0))).sum::<Result<u32, Failure>>()
        })?;
        let seconds = started.elapsed().as_secs_f64();
        println!("{threads} threads: {cached} of {items} cached, {seconds:.3} s");
    }
    Ok(())
}
