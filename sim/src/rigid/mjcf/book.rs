//! The words of MJCF: which elements and attributes are understood, and which are left out without a loss.

/// What an attribute's value must look like.
#[derive(Clone, Copy)]
pub(super) enum Value {
    /// Anything.
    Text,
    /// A whole number that is not negative.
    Mask,
    /// Between so and so many finite numbers.
    Numbers(usize, usize),
    /// One of these words.
    Words(&'static [&'static str]),
    /// The name of a default class.
    Class,
    /// Without a bearing on the model.
    LeftOut,
}

use Value::{Class, LeftOut, Mask, Numbers, Text, Words};

const FLAG: Value = Words(&["true", "false"]);
const AUTO: Value = Words(&["true", "false", "auto"]);

/// An element that is read; all that is not named in it is refused.
pub(super) struct Element {
    pub(super) tag: &'static str,
    pub(super) attributes: &'static [(&'static str, Value)],
    /// Elements that are read in it.
    pub(super) children: &'static [&'static str],
    /// Elements that are passed over with all that is in them.
    pub(super) passed: &'static [&'static str],
}

/// How bodies, frames, geoms and inertials are placed.
pub(super) const POSE: &[(&str, Value)] = &[
    ("pos", Numbers(3, 3)),
    ("quat", Numbers(4, 4)),
    ("axisangle", Numbers(4, 4)),
    ("euler", Numbers(3, 3)),
    ("xyaxes", Numbers(6, 6)),
    ("zaxis", Numbers(3, 3)),
];

/// All elements that are read.
pub(super) const ELEMENTS: &[Element] = &[
    Element {
        tag: "mujoco",
        attributes: &[("model", Text)],
        children: &["compiler", "option", "default", "worldbody", "contact", "actuator"],
        passed: &["size", "statistic", "visual", "custom", "asset", "sensor", "keyframe"],
    },
    Element {
        tag: "compiler",
        attributes: &[
            ("angle", Words(&["degree", "radian"])),
            ("coordinate", Words(&["local"])),
            ("eulerseq", Text),
            ("autolimits", FLAG),
            ("inertiafromgeom", AUTO),
            ("meshdir", LeftOut),
            ("texturedir", LeftOut),
            ("assetdir", LeftOut),
            ("strippath", LeftOut),
            ("discardvisual", LeftOut),
            ("convexhull", LeftOut),
            ("fusestatic", LeftOut),
            ("usethread", LeftOut),
        ],
        children: &[],
        passed: &["lengthrange"],
    },
    Element {
        tag: "option",
        attributes: &[
            ("timestep", LeftOut),
            ("gravity", LeftOut),
            ("magnetic", LeftOut),
            ("integrator", LeftOut),
            ("cone", LeftOut),
            ("jacobian", LeftOut),
            ("solver", LeftOut),
            ("iterations", LeftOut),
            ("tolerance", LeftOut),
            ("ls_iterations", LeftOut),
            ("ls_tolerance", LeftOut),
            ("noslip_iterations", LeftOut),
            ("noslip_tolerance", LeftOut),
            ("impratio", LeftOut),
            ("apirate", LeftOut),
        ],
        children: &[],
        passed: &[],
    },
    Element {
        tag: "default",
        attributes: &[("class", Text)],
        children: &["default", "joint", "geom", "motor"],
        passed: &["site", "camera", "light", "material", "mesh", "pair", "equality", "tendon"],
    },
    Element {
        tag: "worldbody",
        attributes: &[],
        children: &["body", "frame"],
        passed: &["geom", "site", "camera", "light"],
    },
    Element {
        tag: "frame",
        attributes: &[("name", Text), ("childclass", Class)],
        children: &["geom", "body", "frame"],
        passed: &["site", "camera", "light"],
    },
    Element {
        tag: "body",
        attributes: &[("name", Text), ("childclass", Class), ("user", LeftOut), ("sleep", LeftOut)],
        children: &["inertial", "joint", "freejoint", "geom", "body", "frame"],
        passed: &["site", "camera", "light"],
    },
    Element {
        tag: "inertial",
        attributes: &[
            ("mass", Numbers(1, 1)),
            ("diaginertia", Numbers(3, 3)),
            ("fullinertia", Numbers(6, 6)),
        ],
        children: &[],
        passed: &[],
    },
    Element {
        tag: "freejoint",
        attributes: &[("name", Text), ("group", LeftOut)],
        children: &[],
        passed: &[],
    },
    Element {
        tag: "joint",
        attributes: &[
            ("name", Text),
            ("class", Class),
            ("type", Words(&["free", "hinge", "slide", "ball"])),
            ("pos", Numbers(3, 3)),
            ("axis", Numbers(3, 3)),
            ("limited", AUTO),
            ("range", Numbers(2, 2)),
            ("damping", Numbers(1, 1)),
            ("armature", Numbers(1, 1)),
            ("frictionloss", Numbers(1, 1)),
            ("stiffness", Numbers(1, 1)),
            ("springref", Numbers(1, 1)),
            ("ref", Numbers(1, 1)),
            ("margin", LeftOut),
            ("solreflimit", LeftOut),
            ("solimplimit", LeftOut),
            ("solreffriction", LeftOut),
            ("solimpfriction", LeftOut),
            ("group", LeftOut),
            ("user", LeftOut),
        ],
        children: &[],
        passed: &[],
    },
    Element {
        tag: "geom",
        attributes: &[
            ("name", Text),
            ("class", Class),
            (
                "type",
                Words(&[
                    "sphere",
                    "capsule",
                    "cylinder",
                    "box",
                    "plane",
                    "ellipsoid",
                    "mesh",
                    "hfield",
                    "sdf",
                ]),
            ),
            ("size", Numbers(1, 3)),
            ("fromto", Numbers(6, 6)),
            ("mass", Numbers(1, 1)),
            ("density", Numbers(1, 1)),
            ("friction", Numbers(1, 3)),
            ("contype", Mask),
            ("conaffinity", Mask),
            ("mesh", Text),
            ("hfield", Text),
            ("condim", LeftOut),
            ("margin", LeftOut),
            ("gap", LeftOut),
            ("solref", LeftOut),
            ("solimp", LeftOut),
            ("solmix", LeftOut),
            ("priority", LeftOut),
            ("group", LeftOut),
            ("rgba", LeftOut),
            ("material", LeftOut),
            ("user", LeftOut),
        ],
        children: &[],
        passed: &[],
    },
    Element { tag: "contact", attributes: &[], children: &[], passed: &["exclude"] },
    Element { tag: "actuator", attributes: &[], children: &["motor"], passed: &[] },
    Element {
        tag: "motor",
        attributes: &[
            ("name", Text),
            ("class", Class),
            ("joint", Text),
            ("gear", Numbers(1, 6)),
            ("ctrlrange", Numbers(2, 2)),
            ("ctrllimited", AUTO),
            ("group", LeftOut),
            ("user", LeftOut),
        ],
        children: &[],
        passed: &[],
    },
];
