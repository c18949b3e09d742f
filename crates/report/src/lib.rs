//! Documents, figures and a player for moving rigid bodies.
