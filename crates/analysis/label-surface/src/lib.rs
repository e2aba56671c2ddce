//! Maps of labels to a closed mesh.
