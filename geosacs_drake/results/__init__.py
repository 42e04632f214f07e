"""What a run or a canal comes to: measures, summaries, plots and pages."""
