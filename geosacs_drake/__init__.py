"""GeoSACS on Drake: what a person runs."""
