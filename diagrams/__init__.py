"""Drake systems of GeoSACS, and the builders that wire them."""
