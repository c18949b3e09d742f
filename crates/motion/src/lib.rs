//! Strong ground motion: read, process, scale, synthesise and measure.
