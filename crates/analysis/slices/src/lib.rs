//! Slices of a volume, MRI, CT or labels, to the contours of bones in the scanner's millimetres.
