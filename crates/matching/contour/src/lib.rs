//! Which edges of a picture belong to the outline of a posed body: the contour that a person looks at and edits.
