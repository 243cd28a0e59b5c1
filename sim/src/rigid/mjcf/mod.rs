//! Bodies from MJCF files, MuJoCo's format.
//!
//! [`Model::from_mjcf`] reads one body: the one tree under `<worldbody>`. A file says more than a [`Model`] can
//! hold, so each of its elements and attributes has one of three fates, and none is dropped unseen:
//!
//! | | |
//! |---|---|
//! | taken | the tree of bodies and frames with their poses; `free`, `hinge` and `slide` joints with axis, position, range, damping, armature, dry friction; `sphere`, `capsule`, `cylinder` and `box` geoms with size, `fromto`, density or mass, sliding friction; `<inertial>`; `<motor>`s with gear and control range; default classes; angles in degrees or radians |
//! | left to the world that the body is put into | floor and all else that hangs on `<worldbody>` itself; gravity, time step, integrator, solver; softness, margin, priority and `condim` of contacts; spinning and rolling friction; self-contacts (solids of one model never touch each other); keyframes, sensors, sites, cameras, lights, colours, assets |
//! | refused, with the place and the mend | all else: ball joints, springs, joints whose zero is not 0 (`ref`), tendons, equality constraints, meshes, height fields, ellipsoids, actuators that are not motors, controls without a symmetric range, includes, fluids, and every word that is not in MuJoCo's book |
//!
//! A control of 1 is the upper end of the motor's `ctrlrange`. Geoms touch floor and walls when their `contype` or
//! `conaffinity` says so to a partner with masks 1 and 1, MuJoCo's default. The root's [`place`](super::Link::place)
//! is where the file puts it: its height is the one to start a free body from.
//!
//! The parser is `mjcf-rs`, which forgets positions, takes words that it does not know for absent, and overlooks
//! some that it knows. So the text is looked over first, word by word (`vocabulary.rs`).

mod actuators;
mod book;
mod geoms;
mod links;
mod vocabulary;

use super::Model;

/// What is wrong with an MJCF text, where, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("MJCF line {line}, column {column}, {element}: {fault}; {mend}")]
pub struct MjcfError {
    /// Counted from 1.
    pub line: u32,
    /// Counted from 1.
    pub column: u32,
    /// The element with its name, as in `<joint name="hip_1">`.
    pub element: String,
    /// What is wrong with it.
    pub fault: String,
    /// What to do about it.
    pub mend: String,
}

impl Model {
    /// Reads a body from the text of an MJCF file. The [module](self) says what is understood.
    ///
    /// ```
    /// # use inroads_sim::rigid::Model;
    /// let cart = Model::from_mjcf(r#"
    ///   <mujoco model="cart">
    ///     <worldbody>
    ///       <body name="cart" pos="0 0 0.1">
    ///         <joint name="rail" type="slide" axis="1 0 0" damping="0.5"/>
    ///         <geom type="box" size="0.2 0.1 0.05" mass="2"/>
    ///       </body>
    ///     </worldbody>
    ///     <actuator> <motor joint="rail" gear="10" ctrlrange="-3 3"/> </actuator>
    ///   </mujoco>"#)?;
    /// assert_eq!(cart.actuators[0].gear, 30.0);
    /// # Ok::<(), inroads_sim::rigid::MjcfError>(())
    /// ```
    ///
    /// # Errors
    /// [`MjcfError`] names the element at fault, its line and column, and the mend.
    pub fn from_mjcf(xml: &str) -> Result<Self, MjcfError> {
        let places = vocabulary::check(xml)?;
        // Nothing is read from the folder: whatever names a file has been refused.
        let file = mjcf_rs::Model::from_str(xml, ".").map_err(|why| MjcfError {
            line: 1,
            column: 1,
            element: "<mujoco>".to_owned(),
            fault: why.to_string(),
            mend: "mend that value".to_owned(),
        })?;
        let tree = links::read(&file, &places)?;
        let actuators = actuators::read(&file, &places, &tree.joints)?;
        let name = file.name.unwrap_or_else(|| "body".to_owned());
        Ok(Self { name, links: tree.links, actuators })
    }
}
