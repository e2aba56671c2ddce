//! Why there are no fluoroscopes. Pictures of a view count from 0, as in the file of clicks.

/// What stands in the way of an environment.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EnvironmentError {
    /// Pictures and views do not go together.
    #[error(
        "{pictures} bead pictures for {views} views; give every view the same number of pictures, at least one"
    )]
    Pictures {
        /// Pictures given.
        pictures: usize,
        /// Views given.
        views: usize,
    },
    /// A detector that cannot be.
    #[error("view {view}: {what}")]
    Detector {
        /// Which.
        view: String,
        /// What is wrong with it.
        what: String,
    },
    /// The list has too few beads.
    #[error(
        "the bead list has {listed} beads; at least 6 that do not lie in a plane are needed, 20 are good"
    )]
    ShortList {
        /// How many.
        listed: usize,
    },
    /// A bead that is nowhere.
    #[error(
        "bead {name} of the list has a coordinate or a radius that is no usable number; correct the list"
    )]
    NoNumber {
        /// Its name.
        name: String,
    },
    /// Two beads in one place.
    #[error("beads {first} and {second} of the list are at the same place; correct or remove one")]
    SamePlace {
        /// One.
        first: String,
        /// The other.
        second: String,
    },
    /// Beads that lie in a plane do not decide source and detector.
    #[error(
        "{which} lie in a plane: {thickness_mm:.2} mm thick over {extent_mm:.0} mm; a plane does not decide where the source \
         stands: use a frame with beads at different depths"
    )]
    Flat {
        /// The list, or the beads found in a view.
        which: String,
        /// Root mean square distance from their best plane, mm.
        thickness_mm: f64,
        /// Root mean square spread along their longest direction, mm.
        extent_mm: f64,
    },
    /// Too few spots.
    #[error(
        "view {view}, picture {picture}: {found} spots found, {listed} beads listed; at least 6 are needed: is it a picture of \
         the bead frame? If so, see [spots]"
    )]
    TooFew {
        /// Which view.
        view: String,
        /// Which of its pictures.
        picture: usize,
        /// How many spots, or beads that can be used.
        found: usize,
        /// Beads of the list.
        listed: usize,
    },
    /// The frame is not recognised.
    #[error(
        "view {view}, picture {picture}: the frame is not recognised; the best view explains {best} of {listed} beads by the \
         {spots} spots. Check that picture and bead list are of one frame, or name four beads or more in edits/beads_{view}.csv"
    )]
    Unknown {
        /// Which view.
        view: String,
        /// Which of its pictures.
        picture: usize,
        /// Most beads explained.
        best: usize,
        /// Beads of the list.
        listed: usize,
        /// Spots of the picture.
        spots: usize,
    },
    /// The frame looks the same from two sides.
    #[error(
        "view {view}, picture {picture}: two ways to name the beads fit alike ({beads} beads each); name four beads or more in \
         edits/beads_{view}.csv"
    )]
    Ambiguous {
        /// Which view.
        view: String,
        /// Which of its pictures.
        picture: usize,
        /// Beads that the second way explains.
        beads: usize,
    },
    /// Only the mirror image of some pictures fits.
    #[error(
        "{} of view {views} fit{} the bead list as mirror images only{}",
        if *.all { "the pictures" } else { "pictures" },
        if *.all { ", like all pictures," } else { "" },
        if *.all {
            format!("; set mirrored = {} in [environment] if pictures are as seen from {}, or correct the bead list if it is \
                     left-handed (one coordinate with the wrong sign)", !*.mirrored,
                    if *.mirrored { "the source" } else { "behind the detector" })
        } else {
            " while others fit as they are; flip the pictures of those views (bead, plate and study alike)".to_owned()
        }
    )]
    Mirrored {
        /// The views, by name.
        views: String,
        /// Whether it is so for every picture.
        all: bool,
        /// What `mirrored` was set to.
        mirrored: bool,
    },
    /// The sizes of list and detector do not go together.
    #[error(
        "view {view}: the frame is magnified {magnification:.3} times, which cannot be (1 to 5 can); {hint}"
    )]
    Unit {
        /// Which.
        view: String,
        /// Distance of the detector over that of the beads, from the source.
        magnification: f64,
        /// The unit that would fit.
        hint: String,
    },
    /// A click that names nothing.
    #[error("a click at ({:.0}, {:.0}) names {what}; correct the file of clicks", .at_px[0], .at_px[1])]
    ClickOfNothing {
        /// The view, picture or bead that is not there.
        what: String,
        /// Where, recorded px.
        at_px: [f64; 2],
    },
    /// A click beside every spot.
    #[error(
        "view {view}, picture {picture}: the click on bead {bead} at ({:.1}, {:.1}) px is {distance_px:.1} px from the nearest spot, \
         more than {limit_px:.0}; click the bead's middle, or remove it", .at_px[0], .at_px[1]
    )]
    ClickFar {
        /// Which view.
        view: String,
        /// Which of its pictures.
        picture: usize,
        /// The bead's name.
        bead: String,
        /// Where, recorded px.
        at_px: [f64; 2],
        /// To the nearest spot, px; infinite where there is none.
        distance_px: f64,
        /// What is accepted, px.
        limit_px: f64,
    },
    /// Two clicks that contradict each other.
    #[error(
        "view {view}, picture {picture}: clicks on beads {first} and {second} {what}; correct one of them"
    )]
    ClicksClash {
        /// Which view.
        view: String,
        /// Which of its pictures.
        picture: usize,
        /// One bead.
        first: String,
        /// The other.
        second: String,
        /// How they clash.
        what: &'static str,
    },
    /// The clicks do not fit the frame.
    #[error("view {view}, picture {picture}: the clicked beads do not fit the bead list; {hint}")]
    WrongClicks {
        /// Which view.
        view: String,
        /// Which of its pictures.
        picture: usize,
        /// Which ones to look at.
        hint: String,
    },
    /// The beads do not decide the view.
    #[error(
        "view {view}: its {used} beads do not decide where source and detector stand; use beads spread over the picture and in depth"
    )]
    Undecided {
        /// Which.
        view: String,
        /// Beads used.
        used: usize,
    },
}
