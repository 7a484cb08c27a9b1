"""Ways of asking: windows one by one, ties, unknown goals, humans who replan, silent assistance."""
