//! The frames of a trial help each other: what is not good by itself, or jumps, is tried again from the frames beside it.
//!
//! Every frame was matched by itself, so one edited contour reruns one frame. Then, for each body of a trial:
//!
//! 1. Two bodies whose outlines were drawn along the same edges are each tried once without the other's.
//! 2. Frames that are good and go with each other are **settled**. Frames that are good but jump, doubtful, ambiguous or failed are **open**
//!    ([`biplane_trial::jumps`]).
//! 3. In rounds, each open frame next to a settled one is tried from where that says the body is, from before, from after and from between; what
//!    comes out good is settled, so a lost stretch is walked into from both its ends. Where a round settles nothing, frames farther away are
//!    tried, up to `reach_frames`.
//!
//! A frame that a person gave a pose for is left as it came out.
//!
//! **Guaranteed:** the result depends on the matches alone, not on threads or the order of work; what was tried before is in the store. The same
//! walk serves `run` and `explain`. **Not guaranteed:** that a whole trial in the wrong basin is seen.

use std::collections::BTreeMap;

use biplane_artifact::{Contour, Match, PoseRecord, Prediction, Verdict};
use biplane_geometry::{Point3, Pose};
use biplane_optimisation::TrackParams;
use biplane_stage::Hashed;
use biplane_trial::{JumpParams, Predicted, Timed, jumps, predict};
use rayon::prelude::*;

use crate::outcome::StartKind;
use crate::prepare::Prepared;
use crate::steps::ItemError;

/// What one frame gave by itself.
#[derive(Debug, Clone, Default)]
pub struct Single {
    /// One a body of the frame; none where it could not be matched.
    pub matches: Vec<Option<Hashed<Match>>>,
    /// Places of bodies that were drawn to the same edges, and the share of them, of the body that has fewer in the view where it is largest.
    pub shared: Vec<([usize; 2], f64)>,
}

impl Single {
    /// From the matches of a frame's bodies and their outlines in each picture; none where a person drew it, or it is not known.
    pub fn of(matches: Vec<Option<Hashed<Match>>>, contours: &[Vec<Option<&Contour>>]) -> Self {
        let pairs = (0..contours.len()).flat_map(|a| (a + 1..contours.len()).map(move |b| [a, b]));
        let shared = pairs.map(|[a, b]| ([a, b], shared(&contours[a], &contours[b])));
        Self { matches, shared: shared.filter(|(_, share)| *share > 0.0).collect() }
    }
}

/// A body in a frame that is tried again.
#[derive(Debug, Clone)]
pub struct Attempt {
    /// Number of the job.
    pub job: usize,
    /// The body's place in it.
    pub place: usize,
    /// What the frame gave by itself.
    pub own: Hashed<Match>,
    /// Where the frames beside it say it is.
    pub predicted: Vec<Hashed<Prediction>>,
    /// Places of the bodies that are known in this frame, and their matches.
    pub others: Vec<(usize, Hashed<Match>)>,
}

/// Where a body is, where nothing in its own pictures says it.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    /// The pose between those beside it.
    pub pose: PoseRecord,
    /// Labels of the frames that it lies between.
    pub between: [String; 2],
}

/// Brings one body of one frame to its match; `None` where that is not known yet, because nothing runs.
pub type Try<'a> = dyn Fn(&Attempt) -> Result<Option<Hashed<Match>>, ItemError> + Sync + 'a;

/// What came of a trial.
#[derive(Debug, Clone, Default)]
pub struct Tracked {
    /// One a body of each frame, where the frames beside it or the other bodies changed anything.
    pub changed: BTreeMap<(usize, usize), Hashed<Match>>,
    /// Frames that are lost and bridged, where that was asked for.
    pub bridged: BTreeMap<(usize, usize), Bridge>,
}

/// One body over the frames of a trial.
struct Line {
    place: usize,
    /// Numbers of the jobs.
    jobs: Vec<usize>,
    /// When each was taken, in frames.
    at: Vec<f64>,
    pivot: Point3,
    /// Whether each is good and goes with the others.
    settled: Vec<bool>,
    /// Which frames each was tried from last.
    tried: Vec<Option<[Option<usize>; 2]>>,
    /// What the trial's own motion deviates by over one frame, mm and rad.
    usual: (f64, f64),
}

/// When the frames of a trial were taken, in frames: by the numbers in their labels where these grow, else by their places.
fn times(labels: &[&str]) -> Vec<f64> {
    let numbers: Option<Vec<f64>> = labels.iter().map(|l| l.parse::<u64>().ok().map(|n| n as f64)).collect();
    let grow = |n: &Vec<f64>| n.windows(2).all(|w| w[0] < w[1]);
    numbers.filter(grow).unwrap_or_else(|| (0..labels.len()).map(|i| i as f64).collect())
}

/// The share of edges that two bodies of a frame have in common, of the one that has fewer, in the view where it is largest.
fn shared(a: &[Option<&Contour>], b: &[Option<&Contour>]) -> f64 {
    let points = |contour: &Contour| -> BTreeMap<usize, Vec<[usize; 2]>> {
        let mut spans: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
        for piece in contour.pieces.iter().filter(|p| p.first <= p.last) {
            spans.entry(piece.curve).or_default().push([piece.first, piece.last]);
        }
        spans
    };
    let length = |spans: &BTreeMap<usize, Vec<[usize; 2]>>| -> usize {
        spans.values().flatten().map(|[first, last]| last - first + 1).sum()
    };
    let of_view = |(a, b): (&Option<&Contour>, &Option<&Contour>)| {
        let (a, b) = (points((*a)?), points((*b)?));
        let mut common = 0;
        for (curve, spans) in &a {
            for [first, last] in spans {
                for [other_first, other_last] in b.get(curve).into_iter().flatten() {
                    common += (last.min(other_last) + 1).saturating_sub(*first.max(other_first));
                }
            }
        }
        let least = length(&a).min(length(&b));
        (least > 0).then(|| common as f64 / least as f64)
    };
    a.iter().zip(b).filter_map(of_view).fold(0.0, f64::max)
}

/// Tries again what is not good or does not go together; `pivots` are the middles of the study's bodies (model, mm).
///
/// # Errors
/// The first of `attempt`'s that is no failure of one item alone.
pub fn track(
    prepared: &Prepared,
    singles: &[Single],
    pivots: &[Point3],
    attempt: &Try<'_>,
) -> Result<Tracked, ItemError> {
    let params = &prepared.study.tracking;
    let mut tracked = Tracked::default();
    if !prepared.study.tracks() {
        return Ok(tracked);
    }
    apart(prepared, singles, params, attempt, &mut tracked)?;
    let mut lines = lines(prepared, singles, pivots);
    for line in &mut lines {
        settle(line, prepared, singles, &tracked, params);
    }
    let mut gap = 1;
    while gap <= params.reach_frames {
        let next: Vec<(usize, usize, Attempt)> = lines
            .iter()
            .enumerate()
            .flat_map(|(number, line)| {
                let lines = &lines;
                let tracked = &tracked;
                open(line, prepared, gap).filter_map(move |frame| {
                    Some((number, frame, attempt_of(line, lines, frame, singles, tracked, params)?))
                })
            })
            .collect();
        let found: Vec<_> = next.par_iter().map(|(_, _, wanted)| attempt(wanted)).collect();
        let mut moved = false;
        for ((number, frame, wanted), found) in next.iter().zip(found) {
            let line = &mut lines[*number];
            line.tried[*frame] = Some(beside(line, *frame));
            if let Some(found) = found? {
                if found.verdict == Verdict::Good {
                    line.settled[*frame] = true;
                    moved = true;
                }
                tracked.changed.insert((wanted.job, wanted.place), found);
            }
        }
        gap = if moved { 1 } else { gap + 1 };
    }
    if params.bridge {
        for line in &lines {
            bridge(line, prepared, singles, &mut tracked);
        }
    }
    Ok(tracked)
}

/// The bodies of each trial.
fn lines(prepared: &Prepared, singles: &[Single], pivots: &[Point3]) -> Vec<Line> {
    let mut lines = Vec::new();
    for (trial, about) in prepared.study.trials.iter().enumerate() {
        let jobs: Vec<usize> = (0..singles.len()).filter(|j| prepared.jobs[*j].trial == trial).collect();
        let labels: Vec<&str> = jobs.iter().map(|j| prepared.jobs[*j].label.as_str()).collect();
        let at = times(&labels);
        for (place, body) in about.bodies.iter().enumerate() {
            lines.push(Line {
                place,
                at: at.clone(),
                pivot: pivots.get(*body).copied().unwrap_or_else(Point3::origin),
                settled: vec![false; jobs.len()],
                tried: vec![None; jobs.len()],
                jobs: jobs.clone(),
                usual: (0.0, 0.0),
            });
        }
    }
    lines
}

/// The match of a body as it is known now.
fn now<'a>(
    singles: &'a [Single],
    tracked: &'a Tracked,
    job: usize,
    place: usize,
) -> Option<&'a Hashed<Match>> {
    tracked.changed.get(&(job, place)).or_else(|| singles[job].matches.get(place)?.as_ref())
}

/// Bodies of one frame that were drawn to the same edges.
fn apart(
    prepared: &Prepared,
    singles: &[Single],
    params: &TrackParams,
    attempt: &Try<'_>,
    tracked: &mut Tracked,
) -> Result<(), ItemError> {
    let mut wanted = Vec::new();
    for (job, single) in singles.iter().enumerate() {
        let good = |place: usize| single.matches.get(place)?.as_ref().filter(|m| m.verdict == Verdict::Good);
        for place in 0..single.matches.len() {
            let Some(own) = good(place).filter(|_| !given(prepared, job, place)) else { continue };
            let others = single
                .shared
                .iter()
                .filter(|(pair, share)| pair.contains(&place) && *share > params.shared_share);
            let others = others.filter_map(|([a, b], _)| {
                let other = if *a == place { *b } else { *a };
                Some((other, good(other)?.clone()))
            });
            let others: Vec<_> = others.collect();
            if !others.is_empty() {
                wanted.push(Attempt { job, place, own: own.clone(), predicted: Vec::new(), others });
            }
        }
    }
    let found: Vec<_> = wanted.par_iter().map(attempt).collect();
    for (wanted, found) in wanted.iter().zip(found) {
        tracked.changed.extend(found?.map(|found| ((wanted.job, wanted.place), found)));
    }
    Ok(())
}

/// Whether a person gave the pose that a frame starts from.
fn given(prepared: &Prepared, job: usize, place: usize) -> bool {
    prepared.jobs[job].bodies.get(place).is_some_and(|(_, start, _)| *start == StartKind::Edit)
}

/// Finds which frames of a body are good and go with each other.
fn settle(line: &mut Line, prepared: &Prepared, singles: &[Single], tracked: &Tracked, params: &TrackParams) {
    let known: Vec<Option<Timed>> = (0..line.jobs.len())
        .map(|frame| {
            let found = now(singles, tracked, line.jobs[frame], line.place)?;
            let pose = Pose::from(found.pose);
            (found.verdict == Verdict::Good).then_some(Timed { at: line.at[frame], pose })
        })
        .collect();
    line.settled = known.iter().map(Option::is_some).collect();
    let limits = JumpParams {
        factor: params.jump_factor,
        least_mm: params.jump_mm,
        least_rad: params.jump_deg.to_radians(),
    };
    let found = jumps(&known, &line.pivot, &limits);
    line.usual = (found.usual_mm, found.usual_rad);
    if line.usual == (0.0, 0.0) {
        // Too few to tell a usual motion: as far as they move from one to the next.
        let known: Vec<Timed> = known.into_iter().flatten().collect();
        for pair in known.windows(2) {
            let moved = pair[1].pose.error_against(&pair[0].pose, &line.pivot);
            let frames = params.jump_factor * (pair[1].at - pair[0].at);
            line.usual.0 = line.usual.0.max(moved.translation_mm / frames);
            line.usual.1 = line.usual.1.max(moved.rotation_rad / frames);
        }
    }
    for frame in found.frames {
        if !given(prepared, line.jobs[frame], line.place) {
            line.settled[frame] = false;
        }
    }
}

/// The settled frames before and after one.
fn beside(line: &Line, frame: usize) -> [Option<usize>; 2] {
    let before = (0..frame).rev().find(|f| line.settled[*f]);
    let after = (frame + 1..line.settled.len()).find(|f| line.settled[*f]);
    [before, after]
}

/// The open frames of a body within `gap` frames of a settled one that were not tried from there yet.
fn open<'a>(line: &'a Line, prepared: &'a Prepared, gap: usize) -> impl Iterator<Item = usize> + 'a {
    (0..line.settled.len()).filter(move |frame| {
        let beside = beside(line, *frame);
        let near = beside.iter().flatten().any(|other| frame.abs_diff(*other) <= gap);
        !line.settled[*frame]
            && near
            && line.tried[*frame] != Some(beside)
            && !given(prepared, line.jobs[*frame], line.place)
    })
}

/// Where settled frames say a body is: by those before and after, by those before, and by those after.
fn predicted(line: &Line, frame: usize, singles: &[Single], tracked: &Tracked) -> Vec<Predicted> {
    let pose = |f: usize| {
        let found = now(singles, tracked, line.jobs[f], line.place)?;
        Some(Timed { at: line.at[f], pose: found.pose.into() })
    };
    let settled = |frames: &mut dyn Iterator<Item = usize>| -> Vec<Timed> {
        frames.filter(|f| line.settled[*f]).filter_map(pose).take(2).collect()
    };
    let mut before = settled(&mut (0..frame).rev());
    before.reverse();
    let after = settled(&mut (frame + 1..line.settled.len()));
    let all: Vec<Timed> = before.iter().chain(&after).copied().collect();
    let from = |known: &[Timed]| predict(known, line.at[frame], &line.pivot);
    let both = !before.is_empty() && !after.is_empty();
    let all = both.then(|| from(&all)).flatten();
    all.into_iter().chain(from(&before)).chain(from(&after)).collect()
}

/// What an open frame is tried by; none where the frame has no match to improve.
fn attempt_of(
    line: &Line,
    lines: &[Line],
    frame: usize,
    singles: &[Single],
    tracked: &Tracked,
    params: &TrackParams,
) -> Option<Attempt> {
    let job = line.jobs[frame];
    let within = |of: &Predicted| Prediction {
        pose: of.pose,
        within_mm: (params.jump_factor * line.usual.0 * of.spread).max(params.jump_mm),
        within_rad: (params.jump_factor * line.usual.1 * of.spread).max(params.jump_deg.to_radians()),
    };
    let known = |other: &&Line| other.place != line.place && other.jobs.first() == line.jobs.first();
    let others = lines.iter().filter(known).filter(|other| other.settled[frame]);
    Some(Attempt {
        job,
        place: line.place,
        own: singles[job].matches.get(line.place)?.clone()?,
        predicted: predicted(line, frame, singles, tracked).iter().map(|p| Hashed::new(within(p))).collect(),
        others: others
            .filter_map(|o| Some((o.place, now(singles, tracked, job, o.place)?.clone())))
            .collect(),
    })
}

/// Poses of lost frames between those beside them.
fn bridge(line: &Line, prepared: &Prepared, singles: &[Single], tracked: &mut Tracked) {
    for frame in (0..line.jobs.len()).filter(|f| !line.settled[*f]) {
        let lost = now(singles, tracked, line.jobs[frame], line.place);
        let lost = lost.is_none_or(|found| found.verdict == Verdict::Failed);
        let [Some(before), Some(after)] = beside(line, frame) else { continue };
        let Some(found) = predicted(line, frame, singles, tracked).first().copied().filter(|_| lost) else {
            continue;
        };
        let label = |f: usize| prepared.jobs[line.jobs[f]].label.clone();
        let bridge = Bridge { pose: found.pose.into(), between: [label(before), label(after)] };
        tracked.bridged.insert((line.jobs[frame], line.place), bridge);
    }
}
