//! Rigid bodies joined by penalty contact, integrated in time.
