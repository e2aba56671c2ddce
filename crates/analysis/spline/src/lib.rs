//! Cubic splines of the plane, periodic and open: through or near points, with derivatives and the closest point.
