//! Contours of slices to a closed mesh.
