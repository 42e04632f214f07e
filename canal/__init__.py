"""Canal surfaces: demonstrations in, a canal out, points that travel along it. Knows nothing of Drake."""
